#!/usr/bin/env bash
# A signal ends the run after the frame at hand, with manifest and summary.

# What starts a test in the background may ignore SIGINT. A shell hands that on, and can never take it back.
[[ -v DEFAULT_SIGNALS ]] || DEFAULT_SIGNALS=1 exec env --default-signal=HUP,INT,TERM bash "$0"
source "$(dirname "$0")/check.sh"

# Some minutes of frames, so that the run cannot end by itself before the signal comes.
sed -i 's/frames 12/frames 60000/; s/key 12/key 60000/' ball.anim

# wait_for CONDITION: a minute at most; what is not so by then is told by the checks that follow.
wait_for() { for ((tries = 0; tries < 600; ++tries)); do eval "$1" && break || sleep 0.1; done; }

# pictures: how many there are.
pictures() { find out_frames -name '?????.png' 2>/dev/null | wc -l; }

# stopped_by SIGNAL CODE OPTIONS...: sends the signal once two frames are there.
stopped_by() {
  local signal=$1 expected=$2
  shift 2
  rm -rf out_frames
  command="pprt-render $* with SIG$signal"
  pprt-render ball.anim --clock work --budget 1000000 -o out_frames/%05d.png \
    --progress auto "$@" >out 2>err &
  local pid=$!
  wait_for '[[ $(pictures) -ge 2 ]]'
  kill -USR1 "$pid"
  wait_for 'grep -q elapsed err'
  kill "-$signal" "$pid"
  code=0
  wait "$pid" || code=$?
  expect_code "$expected"
  expect_line err 'frame [0-9]* of 60000  [0-9.]* of 4/s  worst [0-9]* ms early  [0-9,]* samples a frame  [0-9:]* left  [0-9.]* s elapsed'
  expect_line err 'stopped: [0-9]* of 60000 frames in out_frames/0.*.png; .*'
  # Every picture is whole and told of in the manifest, and nothing else lies about.
  local others
  others=$(find out_frames -type f ! -name '?????.png' ! -name manifest.ndjson)
  [[ -z $others ]] || complain "'$command' left $others"
  [[ $(wc -l <out_frames/manifest.ndjson) -eq $(($(pictures) + 1)) ]] || complain "'$command': manifest and pictures differ"
}

stopped_by INT 130
stopped_by TERM 143
stopped_by INT 130 -np 2
stopped_by HUP 129
stopped_by HUP 129 -np 2

# No signal is lost while the ranks start: the run, which takes minutes, ends by itself.
set -m # a shell lets jobs in the background ignore SIGINT, unless it watches them
for signal in INT TERM; do
  for delay in 0 0.03 0.06 0.1 0.2 0.4; do
    rm -rf out_frames
    pprt-render ball.anim -np 2 --clock work --budget 1000000 -o "$PWD/out_frames/%05d.png" >out 2>err &
    pid=$! command="a run on 2 ranks that was sent SIG$signal after $delay s"
    # A shell that traps its end hears signals for its child, and may lose them, until that has become the program.
    while [[ /proc/$pid/exe -ef /proc/$$/exe ]]; do :; done
    sleep $delay
    kill "-$signal" "$pid"
    for ((i = 0; i < 200 && $(ps -o stat= -p "$pid" | grep -c '^[^Z]') > 0; ++i)); do sleep 0.1; done
    [[ $i -lt 200 ]] || { complain "$command goes on"; kill -KILL "$pid"; }
    code=0
    wait "$pid" || code=$?
    expect_code $([[ $signal == INT ]] && echo 130 || echo 143)
    for ((i = 0; i < 100; ++i)); do pgrep -f "$PWD/out_frames" >/dev/null || break; sleep 0.1; done
    [[ $i -lt 100 ]] || complain "$command left processes"
  done
done
set +m

# Under nohup a run outlives its terminal.
for np in 1 2; do
  rm -rf out_frames
  nohup pprt-render ball.anim --clock work --budget 1000000 -np $np -o out_frames/%05d.png >out 2>err </dev/null &
  pid=$! command="a run on $np ranks under nohup"
  wait_for '[[ $(pictures) -ge 2 ]]'
  kill -HUP "$pid"
  before=$(pictures)
  wait_for '[[ $(pictures) -gt $((before + 4)) ]]'
  [[ $(pictures) -gt $((before + 4)) ]] || complain "$command makes no more pictures after SIGHUP"
  kill -TERM "$pid"
  code=0
  wait "$pid" || code=$?
  expect_code 143
done

# A run that was to stop and cannot write what it owes has failed.
rm -rf out_frames
pprt-render ball.anim -np 2 --clock work --budget 1000000 -o out_frames/%05d.png --contact-sheet file/sheet.png >out 2>err &
pid=$!
wait_for '[[ $(pictures) -ge 2 ]]'
touch file
kill -INT "$pid"
code=0
wait "$pid" || code=$?
command='a stopped run without its sheet'
expect_code 1

# signal_still SIGNAL ANSWER: sends the signal while the one frame of a still is being made, and awaits the answer, which
# comes before the picture. The still is $pid.
signal_still() {
  pprt-render ball.nff --sampler delaunay --time 3 -s 512x512 -o long.png >out 2>err &
  pid=$!
  wait_for '[[ $(grep SigCgt /proc/$pid/status | cut -f 2) =~ [2367abef]..$ ]]' # it hears SIGUSR1, and what it hears before it
  sleep 1
  kill "-$1" "$pid"
  wait_for "grep -q '$2' err"
  command="a still that was sent SIG$1"
  expect_no_file long.png
}

# A signal is answered at once, though the frame at hand goes on.
signal_still TERM 'a second signal'
expect_line err 'pprt-render: the run ends after the frame at hand; a second signal ends it at once'
code=0
wait "$pid" || code=$?
expect_code 143
expect_file long.png
rm long.png

# A frame that takes long does not keep the status back.
signal_still USR1 elapsed
expect_line err 'frame 0 of 1  [0-9.]* s elapsed'
kill -TERM "$pid"
wait_for 'grep -q "a second signal" err'
kill -TERM "$pid"
command='a still that was sent SIGTERM twice'
code=0
wait "$pid" || code=$?
expect_code 143
expect_no_file long.png
finish

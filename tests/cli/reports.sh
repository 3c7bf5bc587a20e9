#!/usr/bin/env bash
# Standard output carries what was asked for and nothing else.
source "$(dirname "$0")/check.sh"

# The ledger: a line for the run, one a frame, one for the sum.
run pprt-render ball.anim --clock work --budget 400000 --frames 1-2 --stats -; expect_code 0
[[ $(wc -l <out) -eq 4 ]] || complain "the ledger has not four lines: $(cat out)"
expect_line out '{"record":"run","format":2,"version":.*"ranks":1,"size":\[32,24\],"clock":"work".*}'
expect_line out '{"record":"frame","frame":1,"cut":false,"deadline_s":0.25,.*,"non_finite":0,"effort":1.0,"error":{.*}}'
expect_line out '{"record":"frame","frame":2,"cut":false,"deadline_s":0.5,.*,"non_finite":0,"effort":1.0,"error":{.*}}'
expect_line out '{"record":"summary","frames":2,"on_time":2,"late_ms":{.*},.*,"non_finite":0,"error":{.*}}'
expect_line err 'done: 2 of 2 frames in frame_0001.png to frame_0002.png; .*'

# The same ledger on ranks of their own; only the master speaks.
run pprt-render ball.anim --clock work --budget 400000 --frames 1-2 --overwrite -np 3 --stats -; expect_code 0
[[ $(wc -l <out) -eq 4 ]] || complain "the ledger of three ranks has not four lines: $(cat out)"
expect_line out '{"record":"run","format":2,"version":.*"ranks":3,.*}'

# The error against a reference; of a picture to itself it is the rounding of its file.
run pprt-render ball.nff --clock work -o ref.exr; expect_code 0
run pprt-render ball.nff --clock work -o same.exr --reference ref.exr --stats -; expect_code 0
expect_line out '.*"rmse":[0-9.e-]*}'
expect_same ref.exr same.exr

# A reference of another size has no error: it is told once, and the run goes on.
mkdir odd
run pprt-render ball.anim --clock work --budget 400000 --frames 2-3 -o odd/%04d.png --reference ref.exr --stats odd/ledger
expect_code 0
[[ $(grep -c 'pprt-render: warning: --reference: .*; rmse is left out' err) -eq 1 ]] || complain "not one warning: $(cat err)"
if grep -q '},"rmse":' odd/ledger; then complain "an error that was not measured: $(cat odd/ledger)"; fi
# The first frame of a part is no cut.
expect_line odd/ledger '{"record":"frame","frame":2,"cut":false,.*'

# Without a rate time begins with the first frame.
run pprt-render ball.nff --samples 50 -o early.png --stats -; expect_code 0
expect_line out '{"record":"frame","frame":1,.*,"finished_s":[0-9].*}'

# A census alone renders nothing.
run pprt-render ball.nff --census; expect_code 0; expect_text err ''; expect_no_file frame_0000.png
expect_line out '  reflection *yes  1 material with Ks > 0'
expect_line out '  refraction *no   no material with T > 0'
run pprt-render ball.nff --census --clock work --samples 300 -o c.png; expect_code 0; expect_file c.png
expect_line out 'rays traced: 300 primary, .* 0 refraction, 0 visibility'

run pprt-render ball.nff --samples 50 -o p.png --progress none; expect_code 0; expect_text err ''; expect_text out ''
run pprt-render ball.nff --samples 50 -o q.png --progress json; expect_code 0; expect_text out ''
expect_line err '{"event":"frame","frame":1,"done":1,"there":0,"frames":1,.*,"worst_late_ms":.*,"samples_per_frame":.*,"frames_per_second":.*,"seconds_left":0.0}'

# However a run ends, one object tells it, and it is the last one.
expect_end() {
  [[ $(grep -Ec '^\{"event":"(done|stopped|failed)"' err) -eq 1 ]] || complain "'$command': not one end: $(cat err)"
  expect_text <(grep '^{' err | tail -n 1) "$1"
}
expect_end '{"event":"done","done":1,"there":0,"frames":1}'
mkdir broken
printf '#!/bin/sh\ncase "$*" in *-version) exit 0 ;; esac\nexit 3\n' >broken/ffmpeg
chmod +x broken/ffmpeg
for np in 1 2; do
  more=(--clock work --budget 400000 --progress json -np $np)
  run pprt-render ball.anim "${more[@]}" --frames 1-2 -o $np/%d.png; expect_code 0
  expect_end '{"event":"done","done":2,"there":0,"frames":2}'
  run pprt-render ball.anim "${more[@]}" --frames 1-3 -o $np/%d.png --resume; expect_code 0
  expect_end '{"event":"done","done":1,"there":2,"frames":3}'
  run pprt-render ball.anim "${more[@]}" --frames 1-3 -o $np/%d.png; expect_code 2
  expect_end "{\"event\":\"failed\",\"error\":\"$np/1.png is there already; --overwrite replaces it, --resume goes on after it\"}"
  run pprt-render none.nff "${more[@]}"; expect_code 3
  expect_end "{\"event\":\"failed\",\"error\":\"cannot read 'none.nff': No such file or directory\"}"
  PATH=$PWD/broken:$PATH run pprt-render ball.nff "${more[@]}" --fps 4 -o q.png --overwrite --film f.mp4; expect_code 1
  expect_end '{"event":"failed","done":1,"there":0,"frames":1,"error":"cannot write '"'f.mp4'"': ffmpeg ended with code 3"}'
done
run pprt-render ball.nff --progress json --layers foo; expect_code 2
expect_line err '{"event":"failed","error":"--layers foo: .*"}'

# Of a killed rank the launcher tells.
sed 's/frames 12/frames 60000/; s/key 12/key 60000/' ball.anim >long.anim
pprt-render long.anim --clock work --budget 1000000 -np 2 -o long/%05d.png --progress json >out 2>err &
pid=$! command='a run of which a rank is killed' code=0
for ((i = 0; i < 600 && $(find long -name '*.png' 2>/dev/null | wc -l) < 2; ++i)); do sleep 0.1; done
kill -KILL "$(pgrep -P "$(pgrep -P $pid)" | tail -n 1)"
wait $pid || code=$?
expect_code 1
expect_line err '{"event":"failed","error":"rank [01] on .* was ended by signal 9 .*"}'
[[ $(grep -Ec '^\{"event":"(done|stopped|failed)"' err) -eq 1 ]] || complain "'$command': not one end: $(tail -n 3 err)"

# A frame without a rate tells how far it is, on a terminal and to programs.
script -qec 'pprt-render spd:rings -s 512x512 --time 3 -o still.png --overwrite' typescript >out 2>err </dev/null
tr '\r' '\n' <out | grep -q 'frame 1 of 1  [0-9.]* samples a pixel  [0-9]* %  0:0[0-3] left' ||
  complain "no progress within a still on a terminal: $(cat -v out)"
run pprt-render spd:rings -s 512x512 --time 3 -o still.png --overwrite --progress json; expect_code 0
grep -Eq '^\{"event":"sampling","samples_per_pixel":[0-9.]+,"share":0\.[0-9]+,"seconds_left":[0-9.]+\}$' err ||
  complain "no progress within a still: $(cat err)"

# A terminal at the launcher's end is one for rank 0.
for np in 1 2; do
  script -qec "pprt-render ball.anim --frames 1-2 --clock work -o tty/%d.png --overwrite -np $np" typescript >out 2>err </dev/null
  tr '\r' '\n' <out | grep -q 'frame 2 of 2  [0-9.]* of 4/s  worst [0-9]* ms early  [0-9,]* samples a frame  0:00 left' ||
    complain "no progress on a terminal with $np ranks: $(cat -v out)"
done
finish

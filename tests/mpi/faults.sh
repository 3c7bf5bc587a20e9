#!/usr/bin/env bash
# faults.sh FAULT [TIMES]: causes a fault during a run and checks that nothing is lost. Prints the result in one line,
# "fault | what was done | what happened".
#
#   stopped         one rank is stopped for 2 s at 4 frames/s
#   stopped-master  the same for rank 0
#   lost            one rank is killed
#   lost-go-on      the same with --go-on, in real time
#   killed          the whole run is killed, TIMES times at random moments
#   full            the disk is full
#   read-only       the directory cannot be written to
#   slow-network    two of four ranks on another host, 5 to 10 ms away; 5 of 1000 packets are lost
#   bad-network     the same, 40 to 60 ms away, and 10 of 1000 are lost
#
# Exits with 77 (skipped) where a test may not mount a file system or make a network.
source "$(dirname "$0")/lib.sh"
fault=$1 times=${2:-10}
script=$here/moving.anim
frames=28

# Temporary files of a killed MPI are removed with the test's directory.
mkdir tmp
export OMPI_MCA_orte_tmpdir_base=$work/tmp OMPI_MCA_btl_vader_backing_directory=$work/tmp

report() { echo "$fault | $1 | $2"; }

expect_equal() {
  local file
  for file in "$1"/????.png; do
    cmp "$file" "reference/${file##*/}" || fail "$file differs from that of an undisturbed run"
  done
}

# Under the work clock, so that runs can be compared: a second or two for all frames.
counted=(pprt-render spd:tree:5 "$script" -np 3 --clock work --budget 6000000 --progress none)
undisturbed() { "${counted[@]}" -o 'reference/%04d.png'; }

# Checks that the ledger has every frame once, in the order of the script.
expect_every_frame_told() {
  grep -o '"record":"frame","frame":[0-9]*' ledger.ndjson | grep -o '[0-9]*$' | cmp - <(seq $frames) ||
    fail "the ledger does not tell of every frame in its turn"
}

# Prints per frame of the ledger its lateness, ms, and the late ranks between commas.
late_frames() {
  sed -n 's/.*"late_ms":\([-0-9.e]*\),"late_ranks":\[\([0-9,]*\)\].*/\1 ,\2,/p' ledger.ndjson
}

stand_still() {
  local rank=$1 run code=0 process began
  pprt-render spd:tree:5 "$script" -np 4 --progress none -o 'out/%04d.png' --stats ledger.ndjson &
  run=$!
  await_frames out 4
  process=$(rank_process $run "$rank")
  kill -STOP "$process"
  began=$(date +%s%N)
  sleep 2
  kill -CONT "$process"
  echo $((($(date +%s%N) - began) / 1000000)) >stood_ms
  wait $run || code=$?
  [[ $code == 0 ]] || fail "the run ended with code $code"
  expect_frames out png $frames
  expect_whole out
  expect_every_frame_told
  late_frames >late
  # Prints: frames without its pixels; frames from the first of these to the next whole one; largest lateness.
  awk -v rank=",$rank," '
    index($2, rank) { ++missed; if (!first) first = NR }
    first && !back && !index($2, rank) { back = NR - first }
    { if (NR == 1 || $1 > most) most = $1 }
    END { printf "%d %d %.1f\n", missed, back, most }' late
}

# Makes a second host "far": a network namespace at the other end of slow_wire, which mpirun enters instead of using
# ssh. Writes the hostfile "hosts".
make_network() {
  local delay=$1 jitter=$2 loss=$3
  ip link set lo up
  unshare --net --uts sleep 600 &
  far=$!
  slow_wire near far "$delay" "$jitter" "$loss" >wire.log 2>&1 &
  wire=$!
  trap 'kill $wire $far; rm -rf "$work"' EXIT
  for ((i = 0; i < 100; ++i)); do
    # A process that has not yet left this namespace would take the device nowhere.
    if [[ $(readlink /proc/$far/ns/net) != $(readlink /proc/self/ns/net) ]] && grep -q ready wire.log &&
      ip link set far netns $far 2>/dev/null; then break; fi
    kill -0 $wire 2>/dev/null || exit 77
    sleep 0.05
  done
  inside="nsenter --target $far --net --uts --"
  $inside hostname far
  ip addr add 10.83.0.1/24 dev near
  ip link set near up
  $inside ip link set lo up
  $inside ip addr add 10.83.0.2/24 dev far
  $inside ip link set far up
  printf '#!/bin/sh\nshift\nexec %s sh -c "$*"\n' "$inside" >agent
  chmod +x agent
  printf '%s slots=2\n' 10.83.0.1 10.83.0.2 >hosts
  export OMPI_MCA_plm_rsh_agent=$work/agent OMPI_MCA_btl_tcp_if_include=10.83.0.0/24 OMPI_MCA_oob_tcp_if_include=10.83.0.0/24
}

case $fault in
  stopped | stopped-master)
    rank=$([[ $fault == stopped ]] && echo 2 || echo 0)
    figures=$(stand_still "$rank")
    read -r missed back most <<<"$figures"
    [[ $missed -gt 0 ]] || fail "the ledger does not name rank $rank"
    # Deadlines come every 250 ms; the picture is whole again within two.
    deadlines=$((($(<stood_ms) + 249) / 250))
    [[ $back -gt 0 && $back -le $((deadlines + 2)) ]] || fail "rank $rank is not back within two frames (0: never): $back"
    report "rank $rank of 4 stood still for 2 s at 4 frames/s" \
      "all $frames frames; $missed without its pixels, whole again $back frames after the first of these; the latest $most ms after its deadline"
    ;;
  lost)
    undisturbed
    "${counted[@]}" -o 'out/%04d.png' 2>told &
    run=$!
    await_frames out 3
    process=$(rank_process $run 2)
    kill -KILL "$process"
    began=$(date +%s%N) code=0
    wait $run || code=$?
    took=$((($(date +%s%N) - began) / 1000000))
    [[ $code == 1 ]] || fail "the run ended with code $code instead of 1"
    grep -q 'rank 2 on .* was ended by signal 9' told || { cat told >&2; fail "nobody named the rank"; }
    [[ $took -lt 10000 ]] || fail "the run took $took ms to end"
    expect_equal out
    found=$(find out -name '????.png' | wc -l)
    "${counted[@]}" -o 'out/%04d.png' --resume
    expect_frames out png $frames
    expect_equal out
    report "rank 2 of 3 was killed" \
      "exit 1 after $took ms, the rank named; $found frames in place, all whole; --resume made the others, all as undisturbed"
    ;;
  lost-go-on)
    sed "s/frames [0-9]*/frames 56/" "$script" >long.anim
    pprt-render spd:tree:5 long.anim -np 3 --go-on --progress none -o 'out/%04d.png' --stats ledger.ndjson 2>told &
    run=$!
    await_frames out 4
    kill -KILL "$(rank_process $run 2)"
    code=0
    wait $run || code=$?
    [[ $code == 0 ]] || { cat told >&2; fail "the run ended with code $code"; }
    grep -q 'warning: no answer for 8 s from rank 2 on .*; the run goes on without' told ||
      { cat told >&2; fail "nobody named the rank"; }
    expect_frames out png 56
    without=$(grep -c '"lost_ranks":\[2\],"stale_tiles":0' ledger.ndjson || true)
    [[ $without -ge 10 ]] || fail "only $without frames are whole without the rank"
    report "rank 2 of 3 was killed, --go-on" "all 56 frames, the last $without whole ones of two ranks; exit 0"
    ;;
  killed)
    began=$(date +%s%N)
    undisturbed
    whole=$((($(date +%s%N) - began) / 1000000)) # milliseconds of an undisturbed run
    in_place=0 completed=0
    for ((k = 0; k < times; ++k)); do
      "${counted[@]}" -o "$work/out/%04d.png" --resume 2>/dev/null &
      run=$!
      sleep "$(awk -v whole="$whole" -v seed="$RANDOM" 'BEGIN { srand(seed); print rand() * whole / 1000 }')"
      # shellcheck disable=SC2046 # one word a process
      kill -KILL $(family $run) 2>/dev/null || true
      wait $run 2>/dev/null || true
      # A rank that starts at this moment ends without its mpirun, or is killed here.
      while processes=$(pgrep -f "$work/out"); do
        # shellcheck disable=SC2086 # one word a process
        kill -KILL $processes 2>/dev/null || true
        sleep 0.02
      done
      [[ -d out ]] || continue
      found=$(find out -name '????.png' | wc -l)
      if [[ $found -gt 0 ]]; then expect_equal out; fi
      in_place=$((in_place + found))
      if [[ $found == "$frames" ]]; then
        completed=$((completed + 1))
        rm -r out
      fi
    done
    "${counted[@]}" -o "$work/out/%04d.png" --resume
    expect_frames out png $frames
    expect_equal out
    report "3 ranks were killed $times times at random moments and went on with --resume" \
      "$in_place files looked at, all as undisturbed; $((completed + 1)) sequences completed, bit for bit"
    ;;
  full | read-only)
    if [[ -z ${PPRT_OWN_MOUNTS:-} ]]; then
      namespace=(unshare --mount)
      if [[ $(id -u) != 0 ]]; then namespace=(unshare --map-root-user --mount); fi
      mkdir disk
      "${namespace[@]}" mount -t tmpfs none disk 2>/dev/null || exit 77
      PPRT_OWN_MOUNTS=1 "${namespace[@]}" bash "$here/faults.sh" "$fault"
      exit
    fi
    mkdir disk
    trap 'cd / && umount "$work/disk"; rm -rf "$work"' EXIT
    mount -t tmpfs -o size=128k none disk
    code=0
    if [[ $fault == full ]]; then
      "${counted[@]}" -o 'disk/out/%04d.png' 2>told || code=$?
      grep -q "cannot write 'disk/out/.*No space left on device" told || { cat told >&2; fail "nobody told of the disk"; }
      done='the disk had room for 128 KiB'
    else
      "${counted[@]}" -o 'disk/out/%04d.png' --frames 1-4
      mount -o remount,ro disk
      "${counted[@]}" -o 'disk/out/%04d.png' --frames 1-6 --overwrite 2>told || code=$?
      grep -q "cannot write 'disk/out/.*Read-only file system" told || { cat told >&2; fail "nobody told of the directory"; }
      done='the file system became read-only after frame 4'
    fi
    [[ $code == 1 ]] || { cat told >&2; fail "the run ended with code $code instead of 1"; }
    expect_whole disk/out
    others=$(find disk -type f ! -name '????.png' ! -name '*manifest.ndjson')
    [[ -z $others ]] || fail "$others lies about"
    report "$done" "exit 1 and a message; $(find disk/out -name '????.png' | wc -l) frames in place, all whole"
    ;;
  slow-network | bad-network)
    if [[ -z ${PPRT_OWN_NETWORK:-} ]]; then
      namespace=(unshare --net --mount)
      if [[ $(id -u) != 0 ]]; then namespace=(unshare --map-root-user --net --mount); fi
      [[ -c /dev/net/tun ]] && command -v ip >/dev/null && "${namespace[@]}" true 2>/dev/null || exit 77
      PPRT_OWN_NETWORK=1 "${namespace[@]}" bash "$here/faults.sh" "$fault"
      exit
    fi
    distance=(5 5 5) most_late=500
    if [[ $fault == bad-network ]]; then distance=(40 20 10) most_late=1500; fi
    counted=(pprt-render spd:tree:5 "$script" -np 4 --clock work --budget 6000000 --frames 1-4 --progress none)
    make_network "${distance[@]}"
    undisturbed
    # Work clock: the network must not change the result.
    "${counted[@]}" --hostfile hosts -o 'out/%04d.png'
    expect_frames out png 4
    expect_equal out
    # Real time: every frame, in its turn.
    frames=16
    pprt-render spd:tree:5 "$script" -np 4 --hostfile hosts --frames 1-$frames --progress none -o 'real/%04d.png' \
      --stats ledger.ndjson
    expect_frames real png $frames
    expect_whole real
    expect_every_frame_told
    packets=$(ip -s link show near | awk '/RX:/ { getline; print $2 }')
    [[ $packets -gt 1000 ]] || fail "only $packets packets have come from the other host"
    # The first frame waits for all ranks.
    figures=$(late_frames | awk 'NR > 1 { n += $2 != ",,"; if (NR == 2 || $1 > most) most = $1 }
      END { printf "%d %.1f", n, most }')
    read -r lacking most <<<"$figures"
    awk -v most="$most" -v bound=$most_late 'BEGIN { exit !(most < bound) }' ||
      fail "a frame came $most ms after its deadline"
    report "2 of 4 ranks are ${distance[0]} to $((distance[0] + distance[1])) ms away, ${distance[2]} of 1000 packets lost" \
      "4 frames of counted work as undisturbed, bit for bit; all $frames frames at 4 frames/s, $lacking without all pixels; the latest $most ms after its deadline"
    ;;
  *) fail "there is no fault '$fault'" ;;
esac

#!/usr/bin/env bash
# hosts.sh CASE: runs on three hosts. Prints the result in one line, "case | what was done | what happened".
#
#   cable        the third host is cut off without a word; the run ends
#   cable-go-on  the same with --go-on; the others take over
#   clocks       the third host's steady clock is 100,000 s ahead
#
# Exits with 77 (skipped) where a test may not make networks or clocks.
source "$(dirname "$0")/hosts_lib.sh"
own_network "$here/hosts.sh" "$@"
case=$1
make_hosts 3
if [[ $case == clocks ]]; then
  if ! unshare --time --monotonic 100 true 2>/dev/null; then
    echo "clocks: no clocks of one's own here" >&2
    exit 77
  fi
  sed -i 's/$/ unshare --time --monotonic 100000 --fork/' enter.10.84.0.3
fi
enter_by_mpirun

cut_off() { ip link set port3 down; }

# await_frames COUNT
await_frames() {
  for ((i = 0; i < 600; ++i)); do
    if [[ $(find out -name '????.png' 2>/dev/null | wc -l) -ge $1 ]]; then return; fi
    sleep 0.05
  done
  cat told >&2
  fail "there are not $1 frames"
}

# Starts a run of this many frames at 4 frames/s on the three hosts.
start() {
  local frames=$1
  shift
  sed "s/frames [0-9]*/frames $((frames > 28 ? frames : 28))/" "$here/moving.anim" >script.anim
  pprt-render spd:tree:5 script.anim --frames "1-$frames" -np 3 --hostfile hosts --progress none -o "$work/out/%04d.png" --stats ledger.ndjson \
    "$@" 2>told &
  run=$!
}

# Prints the ledger's frames that hold a pattern.
count_frames() { grep '"record":"frame"' ledger.ndjson | grep -c "$1" || true; }

# No process of the run may be left on a host that can be reached.
expect_nobody_left() {
  for ((i = 0; i < 200; ++i)); do
    pgrep -f "=$work/out" >/dev/null || return 0
    sleep 0.05
  done
  fail "processes are left: $(pgrep -af "=$work/out")"
}

case $case in
  cable)
    start 400
    await_frames 8
    cut_off
    began=$(date +%s%N) code=0
    wait $run || code=$?
    took=$((($(date +%s%N) - began) / 1000000))
    [[ $code == 1 ]] || { cat told >&2; fail "the run ended with code $code instead of 1"; }
    grep -q 'error: host 10.84.0.3 does not answer; frames that are in place are whole' told ||
      { cat told >&2; fail "nobody named the host"; }
    [[ $took -lt 10000 ]] || fail "the run took $took ms to end"
    expect_nobody_left
    found=$(find out -name '????.png' | wc -l)
    [[ $found -ge 8 && $found -lt 400 ]] || fail "there are $found frames"
    for file in out/????.png; do pprt-compare "$file" "$file" >/dev/null || fail "$file is not whole"; done
    echo "cable | host 3 of 3 was cut off at 4 frames/s | exit 1 after $took ms, the host named; $found frames in place, all whole"
    ;;
  cable-go-on)
    frames=64
    start $frames --go-on
    await_frames 8
    cut_off
    began=$(date +%s%N) code=0
    wait $run || code=$?
    [[ $code == 0 ]] || { cat told >&2; fail "the run ended with code $code"; }
    grep -q 'warning: no answer for 8 s from rank 2 on host3; the run goes on without' told ||
      { cat told >&2; fail "nobody named the rank"; }
    [[ $(wc -l <told) == 1 ]] || { cat told >&2; fail "more was said"; }
    expect_frames out png $frames
    expect_nobody_left
    late=$(count_frames '"late_ranks":\[2\]') without=$(count_frames '"lost_ranks":\[2\].*"stale_tiles":0')
    [[ $late -ge 20 && $late -le 40 ]] || fail "$late frames lack the rank's pixels"
    [[ $without -ge 10 ]] || fail "only $without frames are whole without the rank"
    echo "cable | host 3 of 3 was cut off at 4 frames/s, --go-on | all $frames frames; $late with its tiles as they were, then $without whole ones of two hosts"
    ;;
  clocks)
    frames=16
    start $frames
    await_frames 2
    for process in $(pgrep -f "=$work/out"); do
      if tr '\0' '\n' 2>/dev/null <"/proc/$process/environ" | grep -qx OMPI_COMM_WORLD_RANK=2; then
        ahead=$(awk '$1 == "monotonic" { print $2 }' "/proc/$process/timens_offsets")
      fi
    done
    [[ ${ahead:-} == 100000 ]] || fail "the clock of rank 2 is not ahead"
    wait $run || { cat told >&2; fail "the run ended with code $?"; }
    [[ ! -s told ]] || { cat told >&2; fail "something was said"; }
    expect_frames out png $frames
    # The first frame waits for all ranks. Clocks that are not compared would leave out every other.
    late=$(count_frames '"late_ranks":\[[0-9]')
    [[ $late -le 4 ]] || fail "$late frames lack a rank's pixels"
    echo "clocks | host 3 of 3 has a clock that is $ahead s ahead | all $frames frames at 4 frames/s, $late without all pixels"
    ;;
  *) fail "there is no case '$case'" ;;
esac

#!/usr/bin/env bash
# kills.sh PROCESS SIGNAL MOMENT [--go-on]: sends the signal to one process of a run on three ranks, at 4 frames/s, and
# checks that the run ends in words within 15 s, or goes on and has all frames; and that no process is left.
# Prints what came of it.
#
#   PROCESS  launcher (pprt-render -np), mpirun, rank0, rank2, guard (of rank 0)
#   SIGNAL   KILL, STOP; a launcher that was stopped is continued after 3 s, as a shell's "fg" would
#   MOMENT   start (the process is there), first (frame, which is not delivered), middle, last (frame)
source "$(dirname "$0")/lib.sh"
process=$1 signal=$2 moment=$3 go_on=${4:-}
frames=12

# Temporary files of a killed MPI are removed with the test's directory.
mkdir tmp
export OMPI_MCA_orte_tmpdir_base=$work/tmp OMPI_MCA_btl_vader_backing_directory=$work/tmp

# shellcheck disable=SC2086 # no word, where the run does not go on
pprt-render spd:tree:5 "$here/moving.anim" -np 3 $go_on --frames 1-$frames --progress none -o "$work/out/%04d.png" 2>told &
run=$!
end_run() {
  # shellcheck disable=SC2046 # one word a process
  kill -KILL $(pgrep -f "$work/out") 2>/dev/null || true
  rm -rf "$work"
}
trap end_run EXIT

target_process() {
  case $process in
    launcher) echo $run ;;
    mpirun) until pgrep -P $run -x mpirun; do kill -0 $run; sleep 0.02; done ;;
    rank0) rank_process $run 0 ;;
    rank2) rank_process $run 2 ;;
    guard) guard_process $run 0 ;;
    *) fail "there is no process '$process'" ;;
  esac
}

target=$(target_process)
case $moment in
  start) ;;
  first) for ((i = 0; i < 1500; ++i)); do [[ -e out/manifest.ndjson ]] && break || sleep 0.02; done ;;
  middle) await_frames out 4 ;;
  last) await_frames out $((frames - 1)) ;;
  *) fail "there is no moment '$moment'" ;;
esac
kill "-$signal" "$target"
began=$(date +%s%N)
if [[ $process$signal == launcherSTOP ]]; then (sleep 3 && kill -CONT $run) & fi

# A run that goes on may have to wait 10 s for a rank at its end.
patience=15
if [[ $process == rank2 && $moment != start ]]; then patience=30; fi
running() { [[ -e /proc/$run && $(cut -d' ' -f3 /proc/$run/stat) != Z ]]; }
took() { echo $((($(date +%s%N) - began) / 100000000)); } # tenths of a second
while running && [[ $(took) -lt $((10 * patience)) ]]; do sleep 0.05; done
if running; then cat told >&2; fail "the run has not ended within $patience s"; fi
time=$(took) code=0
{ wait $run; } 2>/dev/null || code=$?
for ((i = 0; i < 150; ++i)); do pgrep -f "$work/out" >left || break; sleep 0.1; done
if [[ -s left ]]; then fail "processes are left: $(cat left)"; fi
if [[ $process$signal == mpirunKILL && $i -gt 20 ]]; then fail "the ranks have gone on without mpirun for $i tenths of a second"; fi
in_place=0
if [[ -d out ]]; then in_place=$(find out -name '????.png' | wc -l); fi
if [[ $in_place -gt 0 ]]; then expect_whole out; fi

# What the run must say where it does not go on.
case $process$signal in
  launcherKILL) words='' ;;
  mpirunKILL) words='error: mpirun was ended by signal 9 (Killed);' ;;
  mpirunSTOP) words='error: mpirun was stopped by a signal and has not gone on for 8 s;' ;;
  rank?KILL) words="error: rank ${process#rank} on .* was ended by signal 9 (Killed);" ;;
  rank?STOP) words="error: rank ${process#rank} on .* was stopped by signal 19 .* and has not gone on for 8 s;" ;;
  guard*) words='error: \(\(rank 0 on .*\|a rank\) was ended by signal 9 (Killed)\|no sign of rank 0 \(on .* \)\?for 10 s\);' ;;
  *) words='no run ends by this' ;;
esac
expected=1
if [[ $process$signal == launcherKILL ]]; then expected=137; fi
# Whether the run goes on. A moment may have passed before the signal came.
goes_on=no
if [[ $moment == last || $process$signal == guardSTOP ]]; then goes_on=perhaps; fi
if [[ $process$signal == launcherSTOP ]]; then goes_on=yes; fi
if [[ $process == rank2 && $moment != start && ($signal == STOP || -n $go_on) ]]; then
  goes_on=yes
  if [[ $moment == first ]]; then goes_on=perhaps; fi
  grep -q "rank 2 on .* was \(stopped by signal 19\|ended by signal 9\)" told ||
    { cat told >&2; fail "nobody named the rank"; }
fi
seconds="$((time / 10)).$((time % 10)) s"
if [[ $code == 0 && $in_place == "$frames" && $goes_on != no ]]; then
  echo "all frames, $seconds"
elif [[ $goes_on != yes && $code == "$expected" && (-z $words || -n $(grep "$words" told)) ]]; then
  echo "exit $code, $seconds"
else
  cat told >&2
  fail "the run ended with code $code and $in_place frames after $seconds"
fi

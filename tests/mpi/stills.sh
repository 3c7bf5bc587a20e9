#!/usr/bin/env bash
# Frames without a rate end by agreement of the ranks. Repeated runs check that no rank waits for a
# message that has come.
source "$(dirname "$0")/lib.sh"

for run in {1..12}; do
  timeout -k 2 20 pprt-render spd:tree:5 -np 4 -s 96x72 --quality 0.5 --progress none -o still.png --overwrite ||
    fail "run $run ended with code $?"
done
for ranks in 2 4; do
  for quality in '' '--quality 0.05'; do
    # shellcheck disable=SC2086 # two words or none
    timeout -k 2 50 pprt-render spd:tree:5 -np $ranks -s 96x96 $quality --progress none -o still.png --overwrite ||
      fail "$ranks ranks with quality '$quality' ended with code $?"
  done
done

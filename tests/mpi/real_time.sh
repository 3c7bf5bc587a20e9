#!/usr/bin/env bash
# A run in real time ends with every frame. Whether each was on time depends on the machine's load, so the benchmarks
# measure it.
source "$(dirname "$0")/lib.sh"

pprt-render spd:tree:5 "$here/short.anim" --fps 2 -np 2 --progress none -o 'out/####.png' --stats ledger.ndjson
expect_frames out png 6
[[ $(grep -c '"record":"frame"' ledger.ndjson) == 6 ]] || fail "the ledger does not tell of six frames"

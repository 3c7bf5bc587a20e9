#!/usr/bin/env bash
# A sequence in real time ends with every frame. Whether each was on time depends on the machine's load, which a
# test does not control: the benchmarks tell it.
source "$(dirname "$0")/lib.sh"

pprt-render spd:tree:5 "$here/short.anim" --fps 2 -np 2 --progress none -o 'out/####.png' --stats ledger.ndjson
expect_frames out png 6
[[ $(grep -c '"record":"frame"' ledger.ndjson) == 6 ]] || fail "the ledger does not tell of six frames"

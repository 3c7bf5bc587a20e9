#!/usr/bin/env bash
# 32 ranks on any number of cores keep the work clock.
source "$(dirname "$0")/lib.sh"

pprt-render spd:tree:6 "$here/short.anim" --frames 2-4 -np 32 --clock work --progress none -o 'out/%04d.png' \
  --stats ledger.ndjson
expect_frames out png 3
[[ $(grep -c '"record":"frame"' ledger.ndjson) == 3 ]] || fail "the ledger does not tell of three frames"
grep -q '"record":"summary".*"on_time":3' ledger.ndjson || fail "a frame of counted time was late"

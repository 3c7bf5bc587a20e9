#!/usr/bin/env bash
# odd_sizes.sh: images of one tile, of fewer tiles than ranks, and of one row, under every way of balancing: nobody
# divides by what is nothing, and every frame is whole.
source "$(dirname "$0")/lib.sh"
checked=0
while read -r size balance; do
  out=$size-$balance
  pprt-render spd:tree:2 "$here/short.anim" -np 5 --clock work --budget 300000 -s $size --balance $balance \
    --progress none -o "$out/%04d.png" --stats "$out.ndjson" 2>told </dev/null || { cat told >&2; fail "$out ended with code $?"; }
  expect_frames "$out" png 6
  for file in "$out"/????.png; do
    pprt-compare "$file" "$file" >/dev/null || fail "$file is not whole"
  done
  grep -q '"record":"summary","frames":6,.*"non_finite":0' "$out.ndjson" || fail "the ledger of $out tells otherwise"
  if grep -qi 'nan\|inf' "$out.ndjson"; then fail "the ledger of $out has what is no number"; fi
  checked=$((checked + 1))
done <<'RUNS'
1x1 none
1x1 combined
2x2 local
2x2 global
3x200 combined
RUNS
[[ $checked == 5 ]] || fail "only $checked runs were made"

#!/usr/bin/env bash
# odd_runs.sh: images of one tile, of fewer tiles than ranks, and of one row, with every --balance and clock; and
# cameras that turn round, jump and zoom by a million between frames, with every --cast. Every frame must be whole and
# finite.
source "$(dirname "$0")/lib.sh"
cat >odd.anim <<'SCRIPT'
animation {
  frames 6  fps 4  resolution <64, 48>
  camera {
    spline linear
    key 1 { from <4.5, 0.4, 2> at <0, 0, 1> up <0, 0, 1> angle 45 }
    key 2 { at <9, 0.8, 3> }                      // round by 180 degrees: no sample survives
    key 3 { at <0, 0, 1> }
    key 4 { angle 0.000045 }                      // to a millionth
    key 5 { angle 179 }
    key 6 { from <0, 0, 1.5> at <0, 1, 1.5> angle 60 }  // into the tree
  }
}
SCRIPT

# run NAME SCRIPT OPTIONS...
checked=0
clock=(--clock work --budget 300000)
run() {
  local out=$1 script=$2
  shift 2
  pprt-render spd:tree:4 "$script" -np 5 "${clock[@]}" "$@" --progress none -o "$out/%04d.png" \
    --stats "$out.ndjson" 2>told || { cat told >&2; fail "$out ended with code $?"; }
  expect_frames "$out" png 6
  for file in "$out"/????.png; do
    pprt-compare "$file" "$file" >/dev/null || fail "$file is not whole"
  done
  grep -q '"record":"summary","frames":6,.*"non_finite":0' "$out.ndjson" || fail "the ledger of $out tells otherwise"
  if grep -qi 'nan\|inf' "$out.ndjson"; then fail "the ledger of $out has what is no number"; fi
  checked=$((checked + 1))
}

run one-tile-none "$here/short.anim" -s 1x1 --balance none
run one-tile-combined "$here/short.anim" -s 1x1 --balance combined
run four-pixels-local "$here/short.anim" -s 2x2 --balance local
run four-pixels-global "$here/short.anim" -s 2x2 --balance global
run a-row "$here/short.anim" -s 3x200
for cast in off paper verified auto; do run cast-$cast odd.anim --cast $cast; done
[[ $(grep -c '"record":"frame".*"samples_cast":0' cast-paper.ndjson) -gt 1 ]] ||
  fail "samples survived a turn by 180 degrees"
[[ $(grep -c '"record":"frame".*"samples_cast":[1-9]' cast-paper.ndjson) -gt 0 ]] || fail "nothing was cast at all"
clock=(--clock wall --fps 20)
for sampler in auto delaunay; do run wall-$sampler "$here/short.anim" -s 2x1 --sampler $sampler; done
[[ $checked == 11 ]] || fail "only $checked runs were made"

#!/usr/bin/env bash
# However eight ranks are divided into processes and threads, they give the same files under the work clock. In real time
# every frame comes.
source "$(dirname "$0")/lib.sh"

render() { pprt-render spd:tree:5 "$here/short.anim" --progress none "$@"; }
for division in 8x1 4x2 2x4 1x8; do
  render -np "${division%x*}" --threads "${division#*x}" --clock work -o "$division/%04d.png"
  expect_frames "$division" png 6
done
render -np 7 --clock work -o 'seven/%04d.png'
for division in 4x2 2x4 1x8; do
  for file in "$division"/*.png; do
    cmp "$file" "8x1/${file##*/}" || fail "$file differs from that of eight processes"
  done
done
if cmp -s seven/0003.png 8x1/0003.png; then fail "seven ranks give what eight give: the comparison cannot fail"; fi

# Processes may have different numbers of threads.
each() { echo "-np 1 pprt-render spd:tree:5 $here/short.anim --progress none --clock work -o mixed/%04d.png --threads $1"; }
mpirun_by_hand --bind-to none $(each 1) : $(each 5) : $(each 2)
for file in mixed/*.png; do
  cmp "$file" "8x1/${file##*/}" || fail "$file differs from that of eight processes"
done
expect_frames mixed png 6

for division in 2x2 1x4; do
  render -np "${division%x*}" --threads "${division#*x}" --fps 10 -o "real-$division/%04d.png"
  expect_frames "real-$division" png 6
done
render --threads auto --fps 10 -o 'auto/%04d.png'
expect_frames auto png 6

# Ranks that may not use all cores are told of; others are not.
if [[ $(nproc) -gt 1 ]]; then
  core=$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')
  taskset -c "$core" pprt-render spd:tree:3 --threads 2 --samples 500 --progress none -o few.png 2>few
  grep -q "^pprt-render: warning: 2 ranks may use only 1 of this host's [0-9]* cores" few || fail "no warning of one core: $(cat few)"
  taskset -c "$core" pprt-render spd:tree:3 --threads auto --samples 500 --progress none -o auto.png 2>one
  pprt-render spd:tree:3 --threads 2 --samples 500 --progress none -o all.png 2>all
  if grep affinity one all; then fail "a warning of few cores where there are enough"; fi
fi

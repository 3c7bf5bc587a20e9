#!/usr/bin/env bash
# mpirun pprt-render gives the same files as pprt-render -np.
source "$(dirname "$0")/lib.sh"

mpirun_by_hand -np 3 pprt-render spd:tree:5 "$here/short.anim" --clock work --progress none -o 'hand/%04d.png'
pprt-render spd:tree:5 "$here/short.anim" -np 3 --clock work --progress none -o 'own/%04d.png'
expect_frames hand png 6
for file in hand/*.png; do
  cmp "$file" "own/${file##*/}" || fail "$file depends on who calls mpirun"
done

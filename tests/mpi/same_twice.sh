#!/usr/bin/env bash
# same_twice.sh SCENE RANKS: two runs under the work clock give the same files to the byte, with every --cast.
source "$(dirname "$0")/lib.sh"
scene=$1 ranks=$2

for cast in auto paper verified; do
  for run in first again; do
    pprt-render "$scene" "$here/short.anim" -np "$ranks" --clock work --cast $cast --progress none \
      -o "$cast-$run/%04d.exr" -o "$cast-$run/%04d.png"
  done
  expect_frames "$cast-first" exr 6
  expect_frames "$cast-first" png 6
  for file in "$cast-first"/*.{exr,png}; do
    cmp "$file" "$cast-again/${file##*/}" || fail "$file differs from run to run"
  done
done

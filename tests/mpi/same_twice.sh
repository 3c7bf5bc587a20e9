#!/usr/bin/env bash
# same_twice.sh SCENE RANKS: two runs under the work clock give the same files to the byte, with every --cast. The ranks
# are processes in the first run and threads in the second, which takes less time to start.
source "$(dirname "$0")/lib.sh"
scene=$1 ranks=$2

# render CAST DIRECTORY OPTION: the option says what the ranks are.
render() {
  pprt-render "$scene" "$here/short.anim" "$3" "$ranks" --clock work --cast "$1" --progress none \
    -o "$2/%04d.exr" -o "$2/%04d.png"
}

for cast in auto paper verified; do
  render $cast $cast-first -np
  render $cast $cast-again --threads
  expect_frames "$cast-first" exr 6
  expect_frames "$cast-first" png 6
  for file in "$cast-first"/*.{exr,png}; do
    cmp "$file" "$cast-again/${file##*/}" || fail "$file differs from run to run"
  done
done

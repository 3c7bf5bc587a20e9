#!/usr/bin/env bash
# The commands that pprt-render --examples prints, as they stand. Each must make the files that it names.
# The test passes the sources' folder of scenes.
source "$(dirname "$0")/check.sh"
ln -s "$PPRT_SOURCE/scenes" scenes

run pprt-render --examples; expect_code 0; expect_same err /dev/null
mv out examples
[[ $(grep -c '^pprt-' examples) -ge 6 ]] || complain 'there are few examples'
while read -r line; do
  case $line in
    '' | '#'*) continue ;;
    *--live*) continue ;;  # runs until it is stopped; tests of their own watch it
    *--film*) command -v ffmpeg >/dev/null || continue ;;
  esac
  code=0 command=$line
  bash -euc "$line" </dev/null >out 2>err || code=$?
  expect_code 0
done <examples
for file in tree.png balls.png demo/0008.png demo/ledger.ndjson carousel/0024.png same/0002.exr how.png how.samples.png; do
  expect_file "$file"
done
finish

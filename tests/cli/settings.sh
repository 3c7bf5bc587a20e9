#!/usr/bin/env bash
# A run can be repeated from its settings.
source "$(dirname "$0")/check.sh"

run pprt-render ball.anim ball.anim --write-config; expect_code 0; expect_text err ''
options=(ball.anim --clock work --budget 400000 --frames 2-4 -s 20x20 --seed 7 --cast verified --cull)
run pprt-render "${options[@]}" -o a/%04d.png -o a/#.exr --write-config; expect_code 0; expect_text err ''
cp out run.ini
expect_no_file a
expect_line run.ini 'budget=400000'
expect_line run.ini 'max-depth=5'
run pprt-render "${options[@]}" -o a/%04d.png -o a/#.exr; expect_code 0
mv a first
run pprt-render --config run.ini; expect_code 0
for file in 0002.png 0003.png 0004.png 2.exr 3.exr 4.exr; do expect_same first/$file a/$file; done

# The command line comes before the file; what is read can be written again.
run pprt-render --config run.ini --overwrite --frames 3-3 --seed 8; expect_code 0
expect_line err 'done: 1 of 1 frame in .*'
if cmp -s first/0003.png a/0003.png; then complain "another seed gave the same picture"; fi
run pprt-render --config run.ini --write-config; expect_code 0; expect_same out run.ini

# Any name is read back as it was written.
names=('a;b' '#c' '"d"' "it's" 'back\slash\n' ' blanks  within ' '[list]' '[a, b]' 'a,b' "'q'" 'end\' $'line\nend' $'tab\t'
  'false' '7' ' 8' $'K\xe4se' '%04d' '{}' 'a=b' '"; x="')
for name in "${names[@]}"; do
  run pprt-render "$name.nff" --stats "$name" -o "./${name//%/%%}.png" -o "${name//%/%%}.exr" --film "$name.mp4" --write-config
  expect_code 0
  cp out run.ini
  run pprt-render --config run.ini --write-config; expect_code 0; expect_same out run.ini
  cp ball.nff "$name.nff"
  run pprt-render "$name.nff" --samples 50 --stats "$name.led" -o "./${name//%/%%}.png" --write-config
  cp out run.ini
  run pprt-render --config run.ini; expect_code 0
  expect_file "$name.led"; expect_file "./${name//#/1}.png"
done
# Files as people write them.
printf '%s\n' '; comment' '# comment' 'SCENE = ball.nff ; the scene' 'output=[ "x;1.png",' "  'x\2.exr' ]" 'cull' 'samples=50' >by_hand.ini
printf 'size="20x20"\r\n\r\n[default]\nseed=5' >>by_hand.ini
run pprt-render --config by_hand.ini; expect_code 0; expect_file 'x;1.png'; expect_file 'x\2.exr'
printf 'seed=7\nstats="half\n' >bad.ini
run pprt-render ball.nff --config bad.ini; expect_usage "--config: line 2: the quotation mark is not closed"

echo 'colour=red' >bad.ini
run pprt-render ball.nff --config bad.ini; expect_usage "INI was not able to parse colour"
finish

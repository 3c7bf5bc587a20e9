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
run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:2: the quotation mark is not closed"

echo 'colour=red' >bad.ini
run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:1: there is no option 'colour'"

# Problems in the file are told with their line, those of the command line without one.
in_file() { printf "%s\n" '; options' "" "$@" >bad.ini; }
in_file seed=3 fps=fast;     run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:4: --fps: value fast is not a number from 0 to 1000"
in_file clock=sun seed=3;    run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:3: --clock: 'sun' is none of wall, work"
in_file seed=3 cull=true effects=foo np=2; run pprt-render ball.nff --config bad.ini
expect_usage "bad.ini:5: unknown effect 'foo'; there are shadows,highlights,reflection,refraction,smooth-normals,textures,emission,sky, and the words auto, all and none"
in_file size=3;              run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:3: --size 3: want WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 256x256"
in_file sede=3;              run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:3: there is no option 'sede'; did you mean '--seed'?"
in_file write-config=true;   run pprt-render ball.nff --config bad.ini; expect_usage "bad.ini:3: write-config: This option is not allowed in a configuration file"
in_file seed=3;              run pprt-render ball.nff --config bad.ini --fps fast; expect_usage "--fps: value fast is not a number from 0 to 1000"
in_file seed=3;              run pprt-render --config bad.ini; expect_usage "SCENE is required"
in_file fps=fast;            run pprt-render ball.nff --config bad.ini --fps 0 --census; expect_code 0

# A file without an end, and one too large.
limit="--config: the file is larger than 1048576 bytes, the most for options"
run timeout 60 pprt-render ball.nff --config /dev/zero; expect_usage "$limit"
run timeout 60 pprt-render ball.nff --config <(yes seed=3); expect_usage "$limit"
finish

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

echo 'colour=red' >bad.ini
run pprt-render ball.nff --config bad.ini; expect_usage "INI was not able to parse colour"
finish

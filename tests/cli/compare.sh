#!/usr/bin/env bash
# pprt-compare as scripts meet it: figures, limits, exit codes.
source "$(dirname "$0")/check.sh"
work=(--clock work --frames 1-3)

# Few samples against many: a difference that limits can be set to.
run pprt-render ball.anim "${work[@]}" --budget 100000 -o few/%04d.png; expect_code 0
run pprt-render ball.anim "${work[@]}" --budget 2000000 -o many/%04d.png; expect_code 0

run pprt-compare few/0001.png few/0001.png --max-rmse 0 --max-flip 0 --min-ssim 0.999999; expect_code 0
expect_text err ''
expect_line out 'rmse          0'; expect_line out 'psnr, dB      inf'; expect_line out 'flip          0'
run pprt-compare few/0001.png many/0001.png; expect_code 0
expect_line out 'relative mse  [0-9].*'; expect_line out 'ssim          0\..*'; expect_line out 'flip          0\..*'
run pprt-compare few/0001.png many/0001.png --max-flip 1e-6 --max-rmse 1; expect_code 1
expect_line err 'pprt-compare: flip is .*, the limit --max-flip is 1e-06'
run pprt-compare few/0001.png many/0001.png --json; expect_code 0
expect_line out '{"image":"few/0001.png",.*"flip":0\..*,"pixels_per_degree":67.0,"clamped":false,"within":true}'

# Sequences: every frame, and how the error changes from frame to frame.
run pprt-compare few/%04d.png many/####.png --diff d%d.png; expect_code 0
expect_line out '3 frames, 1 to 3'; expect_line out 'flicker  *0\..*[23]'; expect_file d3.png
run pprt-compare few/%04d.png many/%04d.png --max-flicker 1e-6; expect_code 1
expect_line err 'pprt-compare: flicker is .*, the limit --max-flicker is 1e-06'
run pprt-compare few/%04d.png few/%04d.png --max-flicker 0 --max-error 0; expect_code 0
run pprt-compare few/%04d.png many/%04d.png --frames 2-3 --json; expect_code 0
expect_line out '{"record":"frame","frame":2,.*'; expect_line out '{"record":"sequence",.*"frames":2,.*"within":true}'

# No verdict is 2, never 1.
refuse() { # MESSAGE ARGUMENTS...: a run that ends with 2 and says so in its first line
  local message=$1
  shift
  run pprt-compare "$@"; expect_code 2; expect_text out ''
  expect_text <(head -1 err) "pprt-compare: error: $message"
}
refuse "cannot read 'none.png': No such file or directory" none.png few/0001.png
refuse "there are no frames 'none/%04d.png'" none/%04d.png few/%04d.png
refuse "there is no 'few/0004.png'" few/%04d.png many/%04d.png --frames 2-4
refuse "'few/%04d.png' is a sequence and 'many/0001.png' is a single picture" few/%04d.png many/0001.png
refuse "--max-flicker is for sequences such as out/%04d.png" few/0001.png many/0001.png --max-flicker 1
refuse "--pixels-per-degree: value 0 is not a number from 1 to 1000" few/0001.png many/0001.png --pixels-per-degree 0
refuse "--frames 3-1: want FIRST-LAST, counted from 1, such as 1-40" few/%04d.png many/%04d.png --frames 3-1
rm few/0002.png
refuse "there is no 'few/0002.png' to go with 'many/0002.png'; --frames compares a part of the sequences" \
  few/%04d.png many/%04d.png
run pprt-render ball.nff -s 8x8 --samples 64 -o small.png; expect_code 0
refuse "the sizes differ: 'small.png' has 8x8 pixels, 'few/0001.png' has 32x24" small.png few/0001.png
finish

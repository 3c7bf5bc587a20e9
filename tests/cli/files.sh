#!/usr/bin/env bash
# Files written, kept, replaced and skipped.
source "$(dirname "$0")/check.sh"
work=(--clock work --budget 400000)

# Frames in both formats, a manifest and a contact sheet; nothing else is left behind.
run pprt-render ball.anim "${work[@]}" --frames 1-3 -o pics/%04d.png -o pics/#.exr --contact-sheet pics/sheet.png
expect_code 0; expect_text out ''
expect_line err 'done: 3 of 3 frames in pics/%04d.png and pics/#.exr; 3 on time at 4 frames/s, .* samples a frame'
expect_text <(ls pics) "$(printf '%s\n' 0001.png 0002.png 0003.png 1.exr 2.exr 3.exr manifest.ndjson sheet.png)"
[[ $(wc -l <pics/manifest.ndjson) -eq 4 ]] || complain "the manifest has not four lines"

# What is there already is replaced only when asked for.
run pprt-render ball.anim "${work[@]}" --frames 1-3 -o pics/%04d.png
expect_usage "pics/0001.png is there already; --overwrite replaces it, --resume goes on after it"
run pprt-render ball.anim "${work[@]}" --frames 4-5 -o pics/%04d.png --contact-sheet pics/sheet.png
expect_usage "pics/sheet.png is there already; --overwrite replaces it, --resume goes on after it"
cp pics/0002.png before.png
run pprt-render ball.anim "${work[@]}" --frames 2-2 -o pics/%04d.png --overwrite; expect_code 0

# Resuming renders what is missing and nothing else; its sheet shows all frames.
run pprt-render ball.anim "${work[@]}" -o r/%04d.png; expect_code 0
run pprt-render ball.anim "${work[@]}" -o r/%04d.png --resume; expect_code 0
expect_text err 'done: 0 of 12 frames in r/%04d.png'
rm r/0007.png
run pprt-render ball.anim "${work[@]}" -o r/%04d.png --resume --contact-sheet r/sheet.png; expect_code 0
expect_line err 'done: 1 of 12 frames .*'; expect_file r/0007.png; expect_file r/sheet.png
run pprt-render ball.anim "${work[@]}" --seed 2 -o r/%04d.png --resume
expect_usage "--resume: r/manifest.ndjson is of another scene or other options; --overwrite starts anew"

# A directory that cannot be: a file stands in its place.
touch file
run pprt-render ball.nff "${work[@]}" --fps 4 -o file/%04d.png; expect_code 1
expect_text err "pprt-render: error: cannot write 'file/manifest.ndjson': Not a directory"
run pprt-render ball.anim "${work[@]}" -np 2 -o file/%04d.png; expect_code 1
expect_line err "pprt-render: .*error: cannot write 'file/manifest.ndjson': Not a directory"
run pprt-render ball.nff --samples 50 -o s.png --contact-sheet file/sheet.png; expect_code 1; expect_file s.png
expect_line err "pprt-render: error: cannot write 'file/sheet.png': Not a directory"
finish

#!/usr/bin/env bash
# Files written, kept, replaced and skipped.
source "$(dirname "$0")/check.sh"
work=(--clock work --budget 400000)

# Frames in both formats, a manifest and a contact sheet; nothing else is left behind.
run pprt-render ball.anim "${work[@]}" --frames 1-3 -o pics/%04d.png -o pics/#.exr --contact-sheet pics/sheet.png
expect_code 0; expect_text out ''
expect_line err 'done: 3 of 3 frames in pics/0001.png to pics/0003.png, pics/1.exr to pics/3.exr; 3 on time at 4 frames/s, .* samples a frame; RMSE [0-9.a-z() ]*'
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
expect_text err 'done: 0 of 12 frames (12 were there already) in r/0001.png to r/0012.png'
rm r/0007.png
run pprt-render ball.anim "${work[@]}" -o r/%04d.png --resume --contact-sheet r/sheet.png; expect_code 0
expect_line err 'done: 1 of 12 frames (11 were there already) .*'; expect_file r/0007.png; expect_file r/sheet.png
run pprt-render ball.anim "${work[@]}" --seed 2 -o r/%04d.png --resume
expect_usage "--resume: r/manifest.ndjson is of another scene or other options; --overwrite starts anew"

# A frame is finished under the names asked for, in whatever part of the script they are asked for.
run pprt-render ball.anim "${work[@]}" -o r/%04d.png -o r/%04d.exr --frames 2-3 --resume; expect_code 0
expect_line err 'done: 2 of 2 frames in .*'; expect_file r/0003.exr; expect_no_file r/0004.exr
run pprt-render ball.anim "${work[@]}" -o part/%04d.png --frames 1-3 --stats part.ndjson; expect_code 0
run pprt-render ball.anim "${work[@]}" -o part/%04d.png --frames 2-5 --resume --stats part.ndjson; expect_code 0
expect_line err 'done: 2 of 4 frames (2 were there already) in part/0002.png to part/0005.png; .*'
[[ $(grep -c '"record":"frame"' part.ndjson) -eq 5 ]] || complain "resuming did not append to the ledger: $(cat part.ndjson)"

# What ends before it has begun harms nothing that is there.
cp part/manifest.ndjson before.ndjson
touch file
run pprt-render ball.anim "${work[@]}" -o part/%04d.png --overwrite --stats file/ledger; expect_code 1
expect_text err "pprt-render: error: cannot write 'file/ledger': Not a directory"
expect_same before.ndjson part/manifest.ndjson
run pprt-render ball.anim "${work[@]}" -o part/%04d.png --overwrite --reference none/%04d.png
expect_usage "--reference: there is no none/0001.png"
expect_same before.ndjson part/manifest.ndjson

# A directory that cannot be: a file stands in its place.
run pprt-render ball.nff "${work[@]}" --fps 4 -o file/%04d.png; expect_code 1
expect_text err "pprt-render: error: cannot write 'file/0001.png': Not a directory"
run pprt-render ball.anim "${work[@]}" -np 2 -o file/%04d.png; expect_code 1
expect_line err "pprt-render: .*error: cannot write 'file/0001.png': Not a directory"
run pprt-render ball.nff --samples 50 -o s.png --contact-sheet file/sheet.png; expect_code 1; expect_no_file s.png
expect_text err "pprt-render: error: cannot write 'file/sheet.png': Not a directory"

# The manifest grows with every run of the same scene and options.
run pprt-render ball.anim "${work[@]}" --frames 1-3 -o grown/%d.png; expect_code 0
run pprt-render ball.anim "${work[@]}" --frames 4-6 -o grown/%d.png; expect_code 0
run pprt-render ball.anim "${work[@]}" --frames 1-6 -o grown/%d.png --resume; expect_code 0
expect_text err 'done: 0 of 6 frames (6 were there already) in grown/1.png to grown/6.png'
# A frame that is replaced is told of anew; the others stay.
run pprt-render ball.anim "${work[@]}" --frames 2 -o grown/%d.png --overwrite; expect_code 0
[[ $(wc -l <grown/manifest.ndjson) -eq 7 ]] || complain "the manifest has not seven lines: $(cat grown/manifest.ndjson)"
run pprt-render ball.anim "${work[@]}" --frames 1-6 -o grown/%d.png --resume; expect_code 0
expect_text err 'done: 0 of 6 frames (6 were there already) in grown/1.png to grown/6.png'
# One of other options begins anew.
run pprt-render ball.anim "${work[@]}" --seed 2 --frames 7 -o grown/%d.png; expect_code 0
[[ $(wc -l <grown/manifest.ndjson) -eq 2 ]] || complain "the manifest was not begun anew: $(cat grown/manifest.ndjson)"

# A picture of either format that is damaged anywhere is made again, and what is no file is no picture.
run pprt-render ball.anim "${work[@]}" -o sound/%d.png -o sound/%d.exr; expect_code 0
cp -r sound harmed
sed -i 's/sound/harmed/g' harmed/manifest.ndjson
size=$(stat -c %s harmed/2.exr)
truncate -s 100 harmed/1.exr
truncate -s $((size / 2)) harmed/2.exr
truncate -s $((size / 2)) harmed/3.exr; truncate -s "$size" harmed/3.exr
printf 'x' | dd of=harmed/4.png bs=1 seek=300 conv=notrunc status=none
run pprt-render ball.anim "${work[@]}" -o harmed/%d.png -o harmed/%d.exr --resume; expect_code 0
expect_line err 'done: 4 of 12 frames (8 were there already) .*'
for file in sound/[1-9]*; do expect_same "$file" "harmed/${file#*/}"; done
rm harmed/5.exr
mkfifo harmed/5.exr
run timeout 60 pprt-render ball.anim "${work[@]}" -o harmed/%d.png -o harmed/%d.exr --resume; expect_code 1
expect_line err "pprt-render: error: cannot write 'harmed/5.exr': it is not a regular file"
rm harmed/manifest.ndjson
mkfifo harmed/manifest.ndjson
run timeout 60 pprt-render ball.anim "${work[@]}" --frames 1 -o harmed/%d.png --resume; expect_code 1
expect_text err "pprt-render: error: cannot write 'harmed/manifest.ndjson': it is not a regular file"

# While a run goes on, no other one writes to its manifest. A run that was killed is in nobody's way.
sed 's/frames 12/frames 60000/; s/key 12/key 60000/' ball.anim >long.anim  # hours at 4 frames/s
pprt-render long.anim -o shared/%d.png --progress none &
first=$!
until [[ -s shared/manifest.ndjson ]]; do sleep 0.1; done
for flag in --resume --overwrite; do
  run pprt-render ball.anim "${work[@]}" -o shared/%d.png --stats shared.ndjson $flag; expect_code 1
  expect_text err "pprt-render: error: cannot write 'shared/manifest.ndjson': another run is writing to it"
done
expect_no_file shared.ndjson
kill -KILL $first
wait $first || true
run pprt-render ball.anim "${work[@]}" -o shared/%d.png --overwrite; expect_code 0

# A directory that goes in mid-run takes the frames with it: this is told, and the run goes on no longer.
pprt-render ball.anim --fps 0 --time 0.5 -o gone/%d.png 2>err &
until [[ -s gone/1.png ]]; do sleep 0.1; done
mv gone moved
code=0; wait $! || code=$?
command='a run whose directory was moved'
expect_code 1
expect_line err 'failed: [0-9]* of 12 frames in gone/%d.png; .*'
expect_line err "pprt-render: error: cannot write 'gone/manifest.ndjson': it was removed, renamed or replaced while it was written"

# After a power cut files may be empty. They are made again, and an empty manifest is none.
cp -r part cut
: >cut/0002.png
head -c 40 part/0003.png >cut/0003.png
sed -i 's/part/cut/g' cut/manifest.ndjson
run pprt-render ball.anim "${work[@]}" -o cut/%04d.png --frames 1-5 --resume; expect_code 0
expect_line err 'done: 2 of 5 frames (3 were there already) .*'
for frame in 2 3; do expect_same cut/000$frame.png part/000$frame.png; done
: >cut/manifest.ndjson
run pprt-render ball.anim "${work[@]}" -o cut/%04d.png --frames 1-5 --resume; expect_code 0
expect_line err 'done: 5 of 5 frames in .*'
echo 'my notes' >cut/manifest.ndjson
run pprt-render ball.anim "${work[@]}" -o cut/%04d.png --frames 1-5 --resume
expect_usage "--resume: cut/manifest.ndjson is there already and is no manifest; --overwrite replaces it"
run pprt-render ball.anim "${work[@]}" -o cut/%04d.png --frames 6
expect_usage "cut/manifest.ndjson is there already and is no manifest; --overwrite replaces it"

# A run that fails tells how many frames are in place, to people and to programs.
for np in 1 2; do
  for progress in auto json; do
    rm -rf some
    mkdir -p some/3.png
    run pprt-render ball.anim "${work[@]}" -np $np -o some/%d.png --overwrite --progress $progress; expect_code 1
    expect_line err "pprt-render: error: cannot write 'some/3.png': it is a directory"
    in_place=$(find some -type f -name '*.png' | wc -l)
    [[ $progress == json ]] || expect_line err "failed: $in_place of 12 frames in some/%d.png; .*"
    [[ $progress == auto ]] || expect_line err "{\"event\":\"failed\",\"done\":$in_place,\"there\":0,.*"
  done
done

# A picture that memory cannot hold is refused before anything is written.
run bash -c 'ulimit -v 3000000; exec pprt-render ball.nff -s 16384x16384 --samples 500 -o large.png'; expect_code 1
expect_text err 'pprt-render: error: pictures of 16384x16384 pixels take at least 7.2 GB of memory; 3.1 GB are available'
expect_no_file large.png
# An EXR of a frame in real time is compressed by run lengths (1), any other by ZIP (3).
compression_of() { grep -aPo 'compression\x00compression\x00\x01\x00\x00\x00\K.' "$1" | head -c1 | od -An -tu1 | tr -d ' \n'; }
run pprt-render ball.anim --fps 200 --frames 1-1 -o hurried/#.exr; expect_code 0
run pprt-render ball.anim --fps 200 --frames 1-1 --clock work -o worked/#.exr; expect_code 0
run pprt-render ball.nff --samples 500 -o still.exr; expect_code 0
[[ $(compression_of hurried/1.exr)$(compression_of worked/1.exr)$(compression_of still.exr) == 133 ]] ||
  complain "compressions are not run lengths, ZIP and ZIP: $(compression_of hurried/1.exr)$(compression_of worked/1.exr)$(compression_of still.exr)"

# A still has samples, not samples a frame.
run pprt-render ball.nff --clock work --samples 300 -o still.png; expect_code 0
expect_line err 'done: 1 of 1 frame in still.png; [0-9,]* samples; RMSE [0-9.a-z() ]*'
# A name for one frame gets the first of a script.
run pprt-render ball.anim "${work[@]}" -o first.png; expect_code 0
expect_line err "pprt-render: 'first.png' has no place for a number: only frame 1 of 12 is rendered; -o 'first_%04d.png' gives all, -o 'first.mp4' a film"
expect_line err 'done: 1 of 1 frame in first.png; .*'
# A script may stand before its scene.
run pprt-render ball.anim ball.nff "${work[@]}" --frames 1 -o swapped.png; expect_code 0
expect_same swapped.png first.png
# What is written and a second scene are no scripts.
run pprt-render wanted.png ball.nff; expect_code 2
expect_line err "pprt-render: error: 'wanted.png' is neither a scene nor a script; '-o wanted.png' writes it"
run pprt-render ball.nff wanted.mp4; expect_code 2
expect_line err "pprt-render: error: 'wanted.mp4' is neither a scene nor a script; '-o wanted.mp4' writes it"
for second in ball.nff ball.aff ball.glb spd:tree; do
  run pprt-render ball.nff $second; expect_code 2
  expect_line err "pprt-render: error: '$second' is a second scene, beside 'ball.nff'; a script, FILE.anim, can move it there"
done
# A directory is made, but not two that lie in each other.
run pprt-render ball.nff --samples 300 -o near/a.png; expect_code 0; expect_file near/a.png
for option in "-o far/away/a.png" "-o b.png --contact-sheet far/away/s.png" "-o c.png --stats far/away/l.ndjson"; do
  run pprt-render ball.nff --samples 300 $option; expect_code 2
  expect_line err "pprt-render: error: cannot write 'far/away/.*': there is no directory 'far'; make it first"
  expect_no_file far
done
finish

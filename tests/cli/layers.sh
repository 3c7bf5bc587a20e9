#!/usr/bin/env bash
# What shows how a frame came about: --layers and --compare-serial.
source "$(dirname "$0")/check.sh"
work=(--clock work --budget 400000)

# With PNGs a picture a layer beside each, with EXRs channels in them, with both both.
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o p/%04d.png --layers id,samples; expect_code 0; expect_text out ''
expect_text <(ls p) "$(printf '%s\n' 0001.id.png 0001.png 0001.samples.png 0002.id.png 0002.png 0002.samples.png manifest.ndjson)"
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o e/%d.exr --layers all; expect_code 0
expect_text <(ls e) "$(printf '%s\n' 1.exr 2.exr manifest.ndjson)"
for channel in samples.Y triangulation.Y regions.Y age.Y density.Y cost.Y confidence.Y depth.Z normal.X normal.Y \
  normal.Z id.primitive id.material; do
  grep -qF "$channel" e/2.exr || complain "e/2.exr has no channel $channel"
done
run pprt-render ball.nff "${work[@]}" --fps 4 -o b.png -o b.exr --layers regions; expect_code 0
expect_file b.regions.png; grep -qF regions.Y b.exr || complain "b.exr has no channel regions.Y"

# Nothing else changes: the frames are those of a run without layers, on several ranks too.
for ranks in 1 3; do
  run pprt-render ball.anim "${work[@]}" -np $ranks --frames 1-3 -o plain$ranks/%d.png; expect_code 0
  run pprt-render ball.anim "${work[@]}" -np $ranks --frames 1-3 -o full$ranks/%d.png --layers all; expect_code 0
  run pprt-render ball.anim "${work[@]}" -np $ranks --frames 1-3 -o again$ranks/%d.png --layers all; expect_code 0
  for frame in 1 2 3; do expect_same plain$ranks/$frame.png full$ranks/$frame.png; done
  [[ $(ls full$ranks | wc -l) -eq 34 ]] || complain "not ten layers a frame: $(ls full$ranks)"
  # Equal runs give equal layers.
  for picture in full$ranks/*.png; do expect_same "$picture" "again$ranks/${picture#*/}"; done
done
cmp -s full1/3.regions.png full3/3.regions.png && complain "one rank and three have the same regions"

# A frame is finished when its layers are there.
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o p/%04d.png --layers samples --resume; expect_code 0
expect_text err 'done: 0 of 2 frames (2 were there already) in p/0001.png to p/0002.png'
rm p/0002.samples.png
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o p/%04d.png --layers samples,id --resume; expect_code 0
expect_line err 'done: 1 of 2 frames (1 was there already) .*'; expect_file p/0002.samples.png
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o p/%04d.png --layers depth --resume; expect_code 0
expect_line err 'done: 2 of 2 frames in .*'; expect_file p/0001.depth.png
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o e/%d.exr --layers age --resume; expect_code 0
expect_text err 'done: 0 of 2 frames (2 were there already) in e/1.exr to e/2.exr'
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o x/%d.exr; expect_code 0
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o x/%d.exr --layers age --resume; expect_code 0
expect_line err 'done: 2 of 2 frames in x/1.exr to x/2.exr; .*'

# No file is replaced unasked, and nothing that is no layer is taken for one.
run pprt-render ball.anim "${work[@]}" --frames 1-1 -o q/%d.png; expect_code 0
rm q/1.png; touch q/1.age.png
run pprt-render ball.anim "${work[@]}" --frames 1-1 -o q/%d.png --layers age
expect_usage "q/1.age.png is there already; --overwrite replaces it, --resume goes on after it"
run pprt-render ball.nff --layers sample
expect_usage "--layers sample: 'sample' is none of samples, triangulation, regions, age, density, cost, confidence, depth, normal, id, all; did you mean 'samples'?"

# One rank's pattern is the serial one in every frame; that of three ranks is near it, and is not it.
distances() { grep -o '"distance_to_serial":[0-9.e-]*' "$1" | cut -d: -f2; }
run pprt-render ball.anim "${work[@]}" --cast off --sampler delaunay -o s/%d.png --compare-serial --stats s.ndjson; expect_code 0
expect_text <(distances s.ndjson) "$(for _ in {1..12}; do echo 0.0; done)"
run pprt-render ball.anim "${work[@]}" --cast off -np 3 -o t/%d.png --compare-serial --stats t.ndjson; expect_code 0
distances t.ndjson | awk '!($1 > 0 && $1 < 0.5) { bad = 1 } END { exit bad || NR != 12 }' ||
  complain "distances of three ranks: $(distances t.ndjson)"
run pprt-render ball.anim "${work[@]}" --cast off -np 3 -o u/%d.png --stats u.ndjson; expect_code 0
expect_text <(distances u.ndjson) ''
run pprt-render ball.nff --compare-serial; expect_usage "--compare-serial tells the ledger: it needs --stats"
finish

#!/usr/bin/env bash
# pprt-study rate as users meet it: which films it takes, what it tells, its files.
source "$(dirname "$0")/check.sh"

quick=(--quick --size 16 --seconds 0.1)

# A line for each sampler. What it tells depends on the machine's speed, but it is one of the rates.
rate='\(8 frames/s, the lowest tried\|24 frames/s\|60 frames/s, the highest tried\)'
answer="the least RMSE over time, 0\.[0-9]*, is that of $rate; the least FLIP, 0\.[0-9]*, that of $rate"
run pprt-study rate ball.anim "${quick[@]}" -o all --ranks 1; expect_code 0
expect_line out "auto: $answer"; expect_line out "grid: $answer"
[[ $(wc -l <out) -eq 2 ]] || complain "there are other lines: $(cat out)"
expect_line err 'pprt-study: ball.anim: 24 true pictures: .* s'
expect_line err 'pprt-study: ball.anim: 6 runs: .* s'
for file in index.html rates.csv provenance.json; do expect_file "all/$file"; done
if command -v gnuplot >/dev/null; then expect_file all/rate.svg; fi
expect_text <(grep -v '^#' all/rates.csv | cut -d, -f1,2) "$(printf '%s\n' 'sampler,frames/s' auto,{8,24,60} grid,{8,24,60})"
grep -q '"ranks": "1"' all/provenance.json || complain "provenance.json does not tell the ranks"
grep -q 'ball.anim: 0.1 s of it, judged at 240 moments a second' all/index.html || complain "the page does not tell what was judged"
! grep -qE '<(script|link)|src="[^d]' all/index.html || complain "the page needs other files"

# A scene that moves by itself, and a script with the scene named apart.
run pprt-study rate "$PPRT_SOURCE/scenes/rolling-ball.aff" "${quick[@]}"; expect_code 0; expect_line out "auto: $answer"
sed '/scene/d' ball.anim >bare.anim
run pprt-study rate ball.nff bare.anim "${quick[@]}"; expect_code 0; expect_line out "grid: $answer"

# errors SCRIPT: the RMSE over time at 8 frames/s.
errors() {
  run pprt-study rate "$1" "${quick[@]}" -o "$1.d"; expect_code 0
  sed -n 's/^auto,8,\([0-9.e-]*\),.*/\1/p' "$1.d/rates.csv"
}
# What a script moves is seen: held frames of a resting camera are wrong by where it was.
cat >rest.anim <<'SCRIPT'
animation {
  scene "ball.nff"
  frames 4  fps 4  resolution <16, 16>
}
SCRIPT
sed 's/^}/  object "ball.nff" { key 1 { translate <-3, 0, 1> } key 4 { translate <3, 0, 1> } }\n}/' rest.anim >moved.anim
rests=$(errors rest.anim) moves=$(errors moved.anim)
awk "BEGIN { exit !($moves > 2 * $rests) }" || complain "a moved ball errs by $moves, a resting one by $rests"

# Refused.
run pprt-study rate; expect_code 2
run pprt-study rate ball.nff; expect_code 2; expect_line err 'pprt-study: error: ball.nff: nothing moves without a script'
run pprt-study rate ball.anim ball.anim; expect_code 2
expect_line err 'pprt-study: error: there can be one scene and one animation script'
sed 's/fps 4/fps 60/' ball.anim >short.anim
run pprt-study rate short.anim "${quick[@]}" -o x; expect_code 2
expect_line err 'pprt-study: error: short.anim: the film lasts 0.2 s, but is judged from 0.25 s on'
expect_no_file x
# One that ends earlier than is asked for is judged to its end.
sed 's/fps 4/fps 40/' ball.anim >brief.anim
run pprt-study rate brief.anim "${quick[@]}" ; expect_code 0; expect_line err 'pprt-study: brief.anim: 12 true pictures: .* s'
run pprt-study rate missing.anim; expect_code 3
finish

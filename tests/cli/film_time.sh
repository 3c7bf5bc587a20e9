#!/usr/bin/env bash
# --film-time: a film's whole time, divided among its frames.
source "$(dirname "$0")/check.sh"

# Two shots: nothing but the plain background, then a close ball that mirrors its light.
cat >shots.anim <<'SCRIPT'
animation {
  scene "ball.nff"
  frames 8  fps 4  resolution <64, 48>
  camera {
    key 1 { from <0, 0, 5> at <0, 0, 10> up <0, 1, 0> angle 45 }
    key 4 { from <0, 0.1, 5> }
    cut 5 { from <0, 0, 3> at <0, 0, 0> up <0, 1, 0> angle 45 }
    key 8 { from <1, 0, 3> }
  }
}
SCRIPT
film=(pprt-render shots.anim --clock work --film-time 0.4)

# deadlines LEDGER: seconds after the start, a line for each frame.
deadlines() { sed -n 's/.*"deadline_s":\([-0-9.e]*\).*/\1/p' "$1"; }

for ranks in 1 2; do
  run "${film[@]}" --threads $ranks -o "$ranks/%d.png" --stats $ranks.ndjson; expect_code 0
  expect_line err 'pprt-render: 2 of 8 frames were priced in 0\.016 s; a frame gets 0\.0[0-9]* to 0\.0[0-9]* s'
  for frame in 1 8; do expect_file "$ranks/$frame.png"; done
  grep -q '"film_time":0.4' $ranks.ndjson || complain "the ledger does not tell the film's time"
  # Both passes take the time together, and the second shot gets most of it.
  deadlines $ranks.ndjson | awk '{ if (NR == 4) first = $1; all = $1; }
    END { if (NR != 8 || all < 0.3839 || all > 0.3841) { print NR " deadlines, the last at " all " s, not 0.384"; exit 1 }
          if (first > 0.12) { print "the plain shot gets " first " of .384 s"; exit 1 } }' >told || complain "$(cat told)"
  if grep -q '"late_ms":[1-9]' $ranks.ndjson; then complain "a frame is late"; fi
done
# The same again: prices do not depend on the hour.
run "${film[@]}" --threads 2 -o again/%d.png --stats again.ndjson; expect_code 0
for frame in 1 4 5 8; do expect_same again/$frame.png 2/$frame.png; done
expect_text <(deadlines again.ndjson) "$(deadlines 2.ndjson)"
# Some frames of it, on the wall clock: all are there, and whole.
run pprt-render shots.anim --film-time 2 --threads 2 --frames 3-6 -o wall/%d.png --stats wall.ndjson; expect_code 0
expect_line err 'pprt-render: 2 of 4 frames were priced in .* s; a frame gets .* to .* s'
expect_text <(ls wall) "$(printf '%s\n' 3.png 4.png 5.png 6.png manifest.ndjson)"
[[ $(grep -c '"late_ranks":\[\]' wall.ndjson) -eq 4 ]] || complain "frames are not whole: $(cat wall.ndjson)"

for other in '--fps 4=--fps' '--time 1=--time, --samples or --quality' '--samples 9=--time, --samples or --quality' \
  '--quality rmse=0.1=--time, --samples or --quality' '--budget 9 --clock work=--budget' '--live 0=--live' \
  '--resume=--resume, for which it would have to be divided anew' '--go-on=--go-on' '--balance-trace t=--balance-trace'; do
  # shellcheck disable=SC2086
  run pprt-render shots.anim --film-time 1 ${other%=*} -o x/%d.png
  expect_usage "--film-time is the time of all frames: it cannot be used with ${other##*=}"
done
expect_no_file x
finish

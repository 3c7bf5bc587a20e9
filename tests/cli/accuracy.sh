#!/usr/bin/env bash
# pprt-study accuracy as users meet it: files, rows, what is told, the cache of converged frames.
source "$(dirname "$0")/check.sh"

run pprt-study accuracy spd:tree:4 spd:balls:1 -o all --quick --size 48 --repeats 2 --cache kept; expect_code 0
expect_text out ''
expect_line err 'pprt-study: spd:tree:4: converged frame, 32 samples a pixel, its own rmse 0\.0.*'
for file in index.html provenance.json curves.csv comparisons.csv ratios.csv ratios-flip.csv ratios-ssim.csv ratios-flicker.csv means.csv flicker.csv spd-tree-4-crops-100.png; do expect_file "all/$file"; done
grep -q '"command": "pprt-study accuracy spd:tree:4 spd:balls:1 -o all' all/provenance.json ||
  complain "provenance.json does not tell the command: $(cat all/provenance.json)"
grep -q '^# cpu: .' all/curves.csv || complain "curves.csv does not tell the processor"
for method in delaunay uniform control auto 'paper weights' 'area only' 'variance only' 'no pixel rule' 'mean of samples' 'pixel centers' 'stratified random'; do
  for scene in spd:tree:4 spd:balls:1; do
    [[ $(grep -c "^$scene,$method,2," all/curves.csv) -ge 3 ]] || complain "curves.csv lacks the $method of $scene"
  done
done
[[ $(find kept -type f | wc -l) -ge 4 ]] || complain "converged frames are not kept"
grep -q 'A quick trial (--quick)' all/index.html || complain "the page does not tell that it was quick"
! grep -qE '<(script|link)|src="[^d]' all/index.html || complain "the page needs other files"
if command -v gnuplot >/dev/null; then
  for figure in ratios error-time error-samples ablations; do expect_file "all/$figure.svg"; done
fi

for file in renderers.csv effects.csv rates.csv punctuality.csv spd-tree-4-complexity.png spd-balls-1-triangulation.png; do
  expect_file "all/$file"
done
[[ $(grep -c '^spd:tree:4,auto,' all/rates.csv) -eq 3 ]] || complain "rates.csv lacks rates of the tree"
[[ $(grep -cE '^spd:tree:4,(60|120|240),1,' all/punctuality.csv) -eq 3 ]] || complain "punctuality.csv lacks rates of the tree"
grep -q '^spd:balls:1,without reflection,' all/effects.csv || complain "effects.csv lacks the balls without reflection"
grep -q '^spd:tree:4,Tachyon,absent: it shows cones as cylinders,' all/renderers.csv || complain "Tachyon's cones are not told"
if command -v povray >/dev/null; then
  grep -q '^spd:tree:4,POV-Ray,"plain, 1 x 1 samples",' all/renderers.csv || complain "POV-Ray was not run"
fi

# All three measures judge each picture, and each table of ratios ends with the mean and the worst scene.
if grep -v '^#' all/curves.csv | grep -q ',,'; then complain "curves.csv has pictures that are not judged"; fi
for measure in RMSE FLIP '1 - SSIM'; do
  grep -q "^spd:balls:1,paper weights,$measure,1," all/comparisons.csv || complain "comparisons.csv lacks $measure"
done
for table in ratios ratios-flip ratios-ssim; do
  [[ $(tail -n 2 all/$table.csv | cut -d, -f1 | paste -sd,) == 'geometric mean,worst' ]] || complain "$table.csv ends otherwise"
  grep -q '^scene,ms for one sample a pixel,10 %,25 %,50 %,100 %,200 %,400 %,break-even$' all/$table.csv ||
    complain "$table.csv has other columns"
done
[[ $(grep -cE '^spd:tree:4,(delaunay|uniform),(0.25|0.5|1),' all/flicker.csv) -eq 6 ]] || complain "flicker.csv lacks rows of the tree"
grep -q '"busy": "no threads beside the measured one (--busy 0)"' all/provenance.json || complain "provenance.json does not tell that nothing was busy"

# Tables are about the default; without it, about the first method that is compared.
grep -q 'Error of the picture by auto over that of the uniform picture' all/index.html || complain "the page is not about the default"

# Some methods, the curves alone, beside busy threads.
run pprt-study accuracy spd:tree:4 -o some --quick --size 48 --repeats 1 --cache kept --only-curves --methods delaunay --busy 2; expect_code 0
[[ $(grep -v '^#' some/curves.csv | cut -d, -f2 | tail -n +2 | sort -u | paste -sd,) == control,delaunay,uniform ]] ||
  complain "--methods delaunay gave others: $(cut -d, -f2 some/curves.csv | sort -u)"
for file in ratios.csv ratios-flip.csv ratios-ssim.csv flicker.csv index.html; do expect_file "some/$file"; done
grep -q 'Error of the picture by delaunay over that of the uniform picture' some/index.html || complain "the page is about another method"
for file in renderers.csv effects.csv rates.csv punctuality.csv spd-tree-4-complexity.png; do expect_no_file "some/$file"; done
grep -q '^# busy: 2 threads rendered the same scene beside the measured one (--busy 2)' some/curves.csv || complain "curves.csv does not tell --busy 2"
if grep -qE 'Other renderers|Deadlines' some/index.html; then complain "--only-curves shows other sections"; fi

# Without other programs they are reported as absent, and plots are left out.
mkdir bare && ln -s "$(command -v pprt-study)" bare
run env PATH="$PWD/bare" pprt-study accuracy spd:balls:1 -o alone --quick --size 32 --repeats 1 --no-cache --methods delaunay; expect_code 0
grep -q '^spd:balls:1,POV-Ray,absent: povray is not installed,' alone/renderers.csv || complain "POV-Ray's absence is not told"
grep -q '^spd:balls:1,Tachyon,absent: tachyon is not installed,' alone/renderers.csv || complain "Tachyon's absence is not told"

# The planner.
cat >turn.anim <<'SCRIPT'
animation {
  scene "spd:tree:4"
  frames 3
  camera { key 1 { from <4, 0, 2> at <0, 0, 1> up <0, 0, 1> angle 45 } key 3 { from <3.9, 0.8, 2> } }
}
SCRIPT
run pprt-study accuracy turn.anim --quick --size 32 --no-cache --want-fps 100 --repeats 1; expect_code 0
expect_line out 'spd:tree:4: at 100 frames/s the RMSE will be about 0\.0.*'
expect_line out 'spd:tree:4: in real time [0-9]* of 102 frames .* casting and .* FLIP .*'
expect_line out 'spd:tree:4: a viewer sees each frame .* RMSE is then 0\.0.* at 100 frames/s; .* at 50, .* at 200\.'
expect_line err ".* on one rank, by the sampler 'auto', under the work clock.*"
run pprt-study accuracy turn.anim --quick --size 32 --no-cache --want-rmse 0.9 --sampler grid; expect_code 0
expect_line err ".* by the sampler 'grid', .*"
run pprt-study accuracy turn.anim --want-fps 100 --sampler delauney; expect_code 2
run pprt-study accuracy spd:tree:4 --quick --size 32 --no-cache --want-fps 100 --repeats 1; expect_code 0
expect_line out 'spd:tree:4: in real time [0-9]* of 108 frames .*'  # of 12 frames, as often as 100 take
run pprt-study accuracy turn.anim --quick --size 32 --no-cache --want-rmse 0.9; expect_code 0
expect_line out 'spd:tree:4: an RMSE of 0.9 is kept at 240 frames/s and more.'
run pprt-study accuracy turn.anim turn.anim --want-fps 4; expect_code 2

# Kept frames are used: the same file, untouched. Without a cache nothing is kept.
touch -d '2001-01-01' kept/*
run pprt-study accuracy spd:tree:4 -o again --quick --size 48 --repeats 1 --cache kept --only-curves --methods delaunay; expect_code 0
[[ -z $(find kept -type f -newermt '2001-01-02') ]] || complain "a converged frame was made again"
export XDG_CACHE_HOME=$PWD/home
run pprt-study accuracy turn.anim --quick --size 32 --no-cache --want-rmse 0.9; expect_code 0
expect_no_file home
run pprt-study accuracy turn.anim --quick --size 32 --want-rmse 0.9; expect_code 0
[[ $(find home/pprt -type f | wc -l) -ge 2 ]] || complain "the user's cache directory holds no converged frame"

# What a script moves is in the sequence: here it alone makes the frames differ, each of which has a converged one.
printf 's 0 0 1 0.5\n' >ball.nff
cat >hop.anim <<'SCRIPT'
animation {
  scene "spd:tree:4"
  frames 3
  object "ball.nff" { key 1 { translate <0, 0, 0> } key 3 { translate <1, 1, 1> } }
}
SCRIPT
run pprt-study accuracy hop.anim --quick --size 32 --cache hops --want-rmse 0.9; expect_code 0
[[ $(find hops -type f | wc -l) -eq 3 ]] || complain "what the script moves stands still"

# Refused.
run pprt-study accuracy spd:tree:4 -o x --methods unifrom,control; expect_code 2
expect_text err "pprt-study: error: --methods unifrom,control: 'unifrom' is none of auto, uniform, control, delaunay, paper-weights, area-only, variance-only, no-pixel-rule, pixel-area, mean-of-samples, pixel-centers, stratified-random; did you mean 'uniform'?"$'\n'"try 'pprt-study --help'"
run pprt-study accuracy spd:tree:4 -o x --busy -1; expect_code 2; expect_line err '.*--busy.*'; expect_no_file x
run pprt-study accuracy spd:tree:4; expect_code 2; expect_line err '.*--output is required.*'
run pprt-study accuracy spd:bush -o x; expect_code 3; expect_no_file x/index.html
printf 's 0 0 0 1\n' >blind.nff
run pprt-study accuracy blind.nff -o x; expect_code 3; expect_line err '.*the scene has no view.*'
finish

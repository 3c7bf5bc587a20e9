#!/usr/bin/env bash
# pprt-study accuracy as users meet it: files, rows, what is told, the cache of converged frames.
source "$(dirname "$0")/check.sh"

run pprt-study accuracy spd:tree:4 spd:balls:1 -o all --quick --size 48 --repeats 2 --cache kept; expect_code 0
expect_text out ''
expect_line err 'pprt-study: spd:tree:4: converged frame, 32 samples a pixel, its own rmse 0\.0.*'
for file in index.html provenance.json curves.csv comparisons.csv ratios.csv; do expect_file "all/$file"; done
grep -q '"command": "pprt-study accuracy spd:tree:4 spd:balls:1 -o all' all/provenance.json ||
  complain "provenance.json does not tell the command: $(cat all/provenance.json)"
grep -q '^# cpu: .' all/curves.csv || complain "curves.csv does not tell the processor"
for method in progressive uniform control 'area only' 'variance only' 'no pixel rule' 'no average' 'stratified random'; do
  for scene in spd:tree:4 spd:balls:1; do
    [[ $(grep -c "^$scene,$method,2," all/curves.csv) -ge 3 ]] || complain "curves.csv lacks the $method of $scene"
  done
done
[[ $(find kept -type f | wc -l) -eq 2 ]] || complain "not two converged frames are kept"
! grep -qE '<(script|link)|src="[^d]' all/index.html || complain "the page needs other files"
if command -v gnuplot >/dev/null; then
  for figure in ratios error-time error-samples ablations; do expect_file "all/$figure.svg"; done
fi

# Kept frames are used: the same file, untouched. Without a cache nothing is kept.
touch -d '2001-01-01' kept/*
run pprt-study accuracy spd:tree:4 -o again --quick --size 48 --repeats 1 --cache kept; expect_code 0
[[ -z $(find kept -type f -newermt '2001-01-02') ]] || complain "a converged frame was made again"
XDG_CACHE_HOME=$PWD/home run pprt-study accuracy spd:tree:4 -o again --quick --size 48 --repeats 1 --no-cache; expect_code 0
expect_no_file home
XDG_CACHE_HOME=$PWD/home run pprt-study accuracy spd:tree:4 -o again --quick --size 48 --repeats 1; expect_code 0
[[ $(find home/pprt -type f | wc -l) -eq 1 ]] || complain "the user's cache directory holds no converged frame"

# Refused.
run pprt-study accuracy spd:tree:4; expect_code 2; expect_line err '.*--output is required.*'
run pprt-study accuracy spd:bush -o x; expect_code 3; expect_no_file x/index.html
printf 's 0 0 0 1\n' >blind.nff
run pprt-study accuracy blind.nff -o x; expect_code 3; expect_line err '.*the scene has no view.*'
finish

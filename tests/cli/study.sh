#!/usr/bin/env bash
# pprt-study paper as users meet it: files, rows, what is told, with gnuplot and without.
source "$(dirname "$0")/check.sh"

# A Debian machine may lack gnuplot; the study then tells so and goes on.
figures=(simple-2 simple-9 casting scaling costs network)
run pprt-study paper -o all --quick --ranks 2,9 --frames 5; expect_code 0; expect_text out ''
expect_line err 'pprt-study: simple: 96x96, 9 ranks, combined: 5 frames in .* s'
for file in index.html provenance.json frames.csv speedup.csv casting-errors.csv findings.csv; do expect_file "all/$file"; done
if command -v gnuplot >/dev/null; then
  for figure in "${figures[@]}"; do expect_file "all/$figure.svg"; done
  [[ $(grep -c '<svg' all/index.html) -eq ${#figures[@]} ]] || complain "not all plots are on the page"
  # Axes of values begin at 0, so that curves can be compared by their heights.
  for axes in simple-2:6 simple-9:6 casting:6 scaling:5 costs:3; do
    [[ $(grep -cE '<text>\s*0</text>' "all/${axes%:*}.svg") -ge ${axes#*:} ]] || complain "not all axes of ${axes%:*} begin at 0"
  done
fi

# rows FILE EXPERIMENT: data rows of that experiment.
rows() { grep -v '^#' "$1" | awk -F, -v experiment="$2" '$1 == experiment' | wc -l; }
for expected in simple:40 casting:20 scaling:60 costs:15 growth:10 repeat:5 pattern:10 latency:40 bandwidth:35; do
  experiment=${expected%:*}
  [[ $(rows all/frames.csv "$experiment") -eq ${expected#*:} ]] ||
    complain "$(rows all/frames.csv "$experiment") rows of $experiment, not ${expected#*:}"
done
for scene in tree gears balls rings; do
  [[ $(rows all/casting-errors.csv "$scene") -eq 4 ]] || complain "casting-errors.csv lacks rows of $scene"
done
[[ $(grep -c 'casting errors: .*-turn at .* of its speed' err) -eq 8 ]] || complain "not every sequence of the casting trial is told of"
expect_line all/findings.csv '.*Judged by true error, auto is never worse .*'
grep -q '^# cpu: .' all/frames.csv || complain "frames.csv does not tell the processor"
grep -q '"command": "pprt-study paper -o all --quick --ranks 2,9 --frames 5"' all/provenance.json ||
  complain "provenance.json does not tell the command: $(cat all/provenance.json)"

# What is quick says so first, a list of contents stands above, and the page's address is told.
parts='<nav>|A quick trial|>Summary</h2>|figure [5-9]\)</h2>|>Findings</h2>|>How this was measured</h2>'
order='<nav>,A quick trial,>Summary</h2>,figure 5)</h2>,figure 6)</h2>,figure 7)</h2>,figure 8)</h2>,figure 9)</h2>,>Findings</h2>,>How this was measured</h2>'
[[ $(grep -oE "$parts" all/index.html | paste -sd,) == "$order" ]] ||
  complain "the page is not contents, the warning, a summary, the figures and then the findings"
# with VERDICT: how many findings have it.
with() { grep -v '^#' all/findings.csv | tail -n +2 | grep -c ",$1,"; }
summary="$(with holds) of $(grep -v '^#' all/findings.csv | tail -n +2 | wc -l) findings hold, $(with 'does not hold') do not, $(with 'not measured') were not measured."
grep -qF "<p>$summary</p>" all/index.html || complain "the page's summary is not that of findings.csv: $summary"
[[ $(sed '/>Summary<\/h2>/,/<h2/!d' all/index.html | grep -c '<tr><td>') -eq $(with 'does not hold') ]] ||
  complain "the summary does not list what does not hold"
expect_line err "pprt-study: the page is file://$PWD/all/index.html"

# The same figures again, whatever the hour.
figures_of() { grep -v '^#' "$1"; }
hash_of() { figures_of "$1/frames.csv" | grep -m1 "^$2," | sed 's/.*,//'; }  # of the run's first picture
run pprt-study paper -o again --quick --ranks 2,9 --frames 5; expect_code 0
diff <(figures_of all/frames.csv) <(figures_of again/frames.csv) || complain "two studies differ"

# A findings table that calls everything good shows nothing: the control must be there, and hold.
expect_line all/findings.csv '.*Control: without balancing .*,holds,.*'

# Without gnuplot.
bare=$(mktemp -d -p .)
ln -s "$(command -v pprt-study)" "$bare"
run env PATH="$PWD/$bare" "$bare/pprt-study" paper -o bare --quick --ranks 2 --frames 5 --weights learned --seed 2; expect_code 0
expect_line err 'pprt-study: warning: gnuplot is not installed (Debian package gnuplot-nox): tables and page are written without plots'
expect_file bare/index.html; expect_file bare/frames.csv; expect_no_file bare/scaling.svg
grep -q 'The plot is missing: gnuplot is not installed' bare/index.html || complain "the page does not tell what is missing"

# Learned weights and another seed make other pictures, in every experiment: on 2 ranks, on one, and of the casting trial.
# That each of the two does is for unit tests.
for row in simple,simple,2,96,none simple,simple,2,96,combined scaling,simple,1,96,none costs,casting,4,96,combined; do
  [[ $(hash_of all "$row") =~ ^[0-9a-f]{16}$ && $(hash_of all "$row") != "$(hash_of bare "$row")" ]] ||
    complain "$row: --weights learned --seed 2 change nothing"
done
row=$(figures_of all/casting-errors.csv | grep '^tree,1,0.3,')
[[ -n $row ]] && ! grep -qxF "$row" bare/casting-errors.csv || complain "--weights learned --seed 2 change no casting error: $row"
grep -q '"weights": "learned"' bare/provenance.json || complain "provenance.json does not tell the weights"
grep -q '"seed": "2"' bare/provenance.json || complain "provenance.json does not tell the seed"
grep -q '"weights": "paper"' all/provenance.json || complain "provenance.json does not tell the paper's weights"

# Refused.
run pprt-study paper; expect_code 2; expect_line err '.*--output is required.*'
run pprt-study paper -o x --machine sp3; expect_code 2
expect_line err "pprt-study: error: --machine: 'sp3' is none of cluster, sp2; did you mean 'sp2'?"; expect_no_file x
run pprt-study paper -o x --frames 2; expect_code 2; expect_no_file x
touch file
run pprt-study paper -o file/x --quick; expect_code 1; expect_line err "pprt-study: error: cannot write 'file/x/provenance.json': .*"
# Counts of what nobody has published stand alone, and why is told.
run pprt-study counts spd:tree:1 --corners 513; expect_code 0
expect_text err 'spd:tree:1: nothing is published for this size, only for spd:tree:11'
run pprt-study counts spd:tetra --corners 9; expect_code 0
expect_text err 'spd:tetra:6: nothing is published for 9 corners, only for 513'
run pprt-study counts spd:jacks:1 --corners 9 --json; expect_code 0; expect_text err ''
run pprt-study counts spd:jacks:1 --corners 9; expect_text err 'spd:jacks:1: nothing is published for this scene'
finish

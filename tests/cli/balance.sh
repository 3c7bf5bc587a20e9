#!/usr/bin/env bash
# Balancing traces: pprt-render --balance-trace writes them, pprt-study balance shows them.
source "$(dirname "$0")/check.sh"

work=(--clock work --budget 400000 --size 96x64)
run pprt-render ball.anim "${work[@]}" -np 4 -o a/%02d.png --balance-trace a.trace; expect_code 0
[[ $(wc -l <a.trace) -eq 13 ]] || complain "the trace has not 13 lines"
expect_line a.trace '{"record":"trace","format":2,"version":"[^"]*",.*"ranks":4,"size":\[96,64\],.*'
expect_line a.trace '{"record":"frame","frame":12,.*'

# The same decisions on threads, and the same pictures without a trace.
run pprt-render ball.anim "${work[@]}" --threads 4 -o b/%02d.png --balance-trace b.trace; expect_code 0
expect_same a.trace b.trace
run pprt-render ball.anim "${work[@]}" --threads 4 -o c/%02d.png; expect_code 0
for frame in a/*.png; do expect_same "$frame" "c/${frame#a/}"; done

# One trace: a row for each frame and one for the trace.
run pprt-study balance a.trace; expect_code 0; expect_text err ''
expect_line out 'trace  *balance  *frame  *deviation  *max_over_mean  *tiles_moved  *tiles_given  *repartitioned'
[[ $(grep -cE '^a +combined +[0-9]+( +[0-9]+\.[0-9]{3}){2}( +[0-9]+){3}$' out) -eq 13 ]] || complain "not 12 frames and a sum: $(cat out)"
expect_line out 'a  *combined  *12  *[0-9.]*  *[0-9.]*  *[1-9][0-9]*  *[0-9]*  *[0-9]*'

# Several: the deviations side by side, and a row for each.
for balance in none local; do
  run pprt-render ball.anim "${work[@]}" --threads 4 --balance $balance -o $balance/%02d.png --balance-trace $balance.trace; expect_code 0
done
run pprt-study balance none.trace a.trace; expect_code 0; expect_text err ''
expect_line out 'frame  *none  *a'
[[ $(grep -cE '^[0-9]+( +[0-9]\.[0-9]{3}){2}$' out) -eq 12 ]] || complain "not 12 frames: $(cat out)"
expect_line out 'none  *none  *12  *[0-9.]*  *[0-9.]*  *0  *0  *0'
run pprt-study balance none.trace a.trace --json; expect_code 0
[[ $(grep -c '^{"record":"frame","trace":"[a-z]*","balance":"[a-z]*","frame":[0-9]*,"deviation":.*}$' out) -eq 24 ]] || complain "not 24 frames: $(cat out)"
[[ $(grep -c '^{"record":"trace",.*}$' out) -eq 2 ]] || complain "not 2 traces: $(cat out)"
run pprt-study balance local.trace none.trace -o study --frames 2,7; expect_code 0
for file in index.html frames.csv traces.csv provenance.json regions-{local,none}-{2,7}.png; do expect_file "study/$file"; done
[[ $(grep -vc '^#' study/frames.csv) -eq 25 ]] || complain "frames.csv has not 25 lines: $(cat study/frames.csv)"
if command -v gnuplot >/dev/null; then expect_file study/balance.svg; fi
run pprt-render ball.anim "${work[@]}" --threads 3 --frames 1-6 -o e/%02d.png --balance-trace e.trace; expect_code 0
run pprt-study balance a.trace e.trace; expect_code 0
expect_text err "warning: a.trace and e.trace are runs of different numbers of ranks"
run pprt-study balance a.trace ./a.trace; expect_code 2
expect_line err "pprt-study: error: a.trace and ./a.trace have the same name; give each trace a name of its own"

# A trace is an output as the ledger is.
there="is there already; --overwrite replaces it, --resume goes on after it"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --balance-trace a.trace; expect_usage "a.trace $there"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --balance-trace ball.nff --overwrite
expect_usage "the scene ball.nff and --balance-trace ball.nff are the same file; give each a name of its own"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --balance-trace x --stats x
expect_usage "--stats x and --balance-trace x are the same file; give each a name of its own"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --balance-trace -; expect_usage "--balance-trace -: want the name of a file"
run pprt-render ball.anim --live 0 --balance-trace x; expect_usage "--live changes its settings on the way: it takes no --balance-trace"
expect_no_file x
run pprt-render ball.anim "${work[@]}" --threads 4 -o a/%02d.png --balance-trace a.trace --overwrite; expect_code 0
expect_same a.trace b.trace
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --balance-trace a/01.png/x; expect_code 1
expect_text err "pprt-render: error: cannot write 'a/01.png/x': Not a directory"

# A killed run leaves half a line; the resumed one begins a trace of its own behind it.
run pprt-render ball.anim "${work[@]}" --threads 4 --frames 1-6 -o r/%02d.png --balance-trace r.trace; expect_code 0
printf '{"record":"fra' >>r.trace
run pprt-render ball.anim "${work[@]}" --threads 4 -o r/%02d.png --balance-trace r.trace --resume; expect_code 0
run pprt-study balance r.trace; expect_code 0
expect_text err "r.trace:8: warning: the line is incomplete and left out"
expect_line out 'r  *combined  *12  *[0-9.]*  *[0-9.]*  *[0-9]*  *[0-9]*  *[0-9]*'

# Refused.
run pprt-study balance missing; expect_code 3; expect_text err "cannot read 'missing': No such file or directory"
run pprt-study balance ball.nff; expect_code 3; expect_text err "ball.nff:1: error: the line is no JSON"
sed '3s/"owner":\[0/"owner":[9/' b.trace >bad.trace
run pprt-study balance bad.trace; expect_code 3; expect_text err 'bad.trace:3: error: "owner" holds a value out of range'
head -1 b.trace >head.trace
run pprt-study balance head.trace; expect_code 3; expect_text err "head.trace:1: error: the trace holds no frame"
run pprt-study balance b.trace --frames 13; expect_code 2
expect_line err "pprt-study: error: --frames 13: b.trace has no such frame"
run pprt-study balance; expect_code 2
finish

#!/usr/bin/env bash
# Balancing traces: pprt-render --trace writes them, pprt-study balance replays them.
source "$(dirname "$0")/check.sh"

work=(--clock work --budget 400000 --size 96x64)
run pprt-render ball.anim "${work[@]}" -np 4 -o a/%02d.png --trace a.trace; expect_code 0
[[ $(wc -l <a.trace) -eq 13 ]] || complain "the trace has not 13 lines"
expect_line a.trace '{"record":"trace","format":1,"version":"[^"]*",.*"ranks":4,"size":\[96,64\],.*'
expect_line a.trace '{"record":"frame","frame":12,.*'

# The same decisions on threads, and the same pictures without a trace.
run pprt-render ball.anim "${work[@]}" --threads 4 -o b/%02d.png --trace b.trace; expect_code 0
expect_same a.trace b.trace
run pprt-render ball.anim "${work[@]}" --threads 4 -o c/%02d.png; expect_code 0
for frame in a/*.png; do expect_same "$frame" "c/${frame#a/}"; done

# The policy that ran is exact, another one is not.
run pprt-study balance a.trace --policy combined,none; expect_code 0; expect_text err ''
expect_line out 'policy  *frame  *deviation  *max_over_mean  *tiles_moved  *repartitioned  *tiles_differing'
[[ $(grep -cE '^combined +[0-9]+ .* 0$' out) -eq 12 ]] || complain "combined is not replayed exactly: $(cat out)"
expect_line out 'none  *[0-9.]*  *[0-9.]*  *0  *0  *[1-9][0-9]*'
run pprt-study balance a.trace --json; expect_code 0
[[ $(grep -c '^{"record":"round","policy":"[a-z]*","frame":[0-9]*,"deviation":.*}$' out) -eq 48 ]] || complain "not 48 rounds: $(cat out)"
[[ $(grep -c '^{"record":"policy",.*}$' out) -eq 4 ]] || complain "not 4 policies: $(cat out)"
run pprt-study balance a.trace -o study --policy local,none --frames 2,7; expect_code 0
for file in index.html rounds.csv policies.csv provenance.json regions-{local,none}-{2,7}.png; do expect_file "study/$file"; done
[[ $(grep -vc '^#' study/rounds.csv) -eq 25 ]] || complain "rounds.csv has not 25 lines: $(cat study/rounds.csv)"
if command -v gnuplot >/dev/null; then expect_file study/balance.svg; fi

# A trace is an output as the ledger is.
there="is there already; --overwrite replaces it, --resume goes on after it"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --trace a.trace; expect_usage "a.trace $there"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --trace ball.nff --overwrite
expect_usage "the scene ball.nff and --trace ball.nff are the same file; give each a name of its own"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --trace x --stats x
expect_usage "--stats x and --trace x are the same file; give each a name of its own"
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --trace -; expect_usage "--trace -: want the name of a file"
run pprt-render ball.anim --live 0 --trace x; expect_usage "--live changes its settings on the way: it takes no --trace"
expect_no_file x
run pprt-render ball.anim "${work[@]}" --threads 4 -o a/%02d.png --trace a.trace --overwrite; expect_code 0
expect_same a.trace b.trace
run pprt-render ball.anim "${work[@]}" -o d/%02d.png --trace a/01.png/x; expect_code 1
expect_text err "pprt-render: error: cannot write 'a/01.png/x': Not a directory"

# A killed run leaves half a line; the resumed one begins a trace of its own behind it.
run pprt-render ball.anim "${work[@]}" --threads 4 --frames 1-6 -o r/%02d.png --trace r.trace; expect_code 0
printf '{"record":"fra' >>r.trace
run pprt-render ball.anim "${work[@]}" --threads 4 -o r/%02d.png --trace r.trace --resume; expect_code 0
run pprt-study balance r.trace --policy combined; expect_code 0
expect_text err "r.trace:8: warning: the line is incomplete and left out"
expect_line out 'combined  *12 .* 0'

# Refused.
run pprt-study balance none.trace; expect_code 3; expect_text err "cannot read 'none.trace': No such file or directory"
run pprt-study balance ball.nff; expect_code 3; expect_text err "ball.nff:1: error: the line is no JSON"
sed '3s/"owner":\[0/"owner":[9/' b.trace >bad.trace
run pprt-study balance bad.trace; expect_code 3; expect_text err 'bad.trace:3: error: "owner" holds a value out of range'
head -1 b.trace >head.trace
run pprt-study balance head.trace; expect_code 3; expect_text err "head.trace:1: error: the trace holds no frame"
run pprt-study balance b.trace --policy globl; expect_code 2
expect_line err "pprt-study: error: --policy globl: 'globl' is none of none, local, global, combined; did you mean 'global'?"
run pprt-study balance b.trace --frames 13; expect_code 2
expect_line err "pprt-study: error: --frames 13: the trace has no such frame"
run pprt-study balance; expect_code 2
finish

#!/usr/bin/env bash
# check_test.sh COST: what `cost --check` and `cost --update` make of tables that were measured before.
source "$(dirname "$0")/../cli/check.sh"
cost=$1

# table INSTRUCTIONS D1: what cost prints, with these figures in its first row.
table() {
  cat <<TABLE
Instruction set: the clones for x86-64-v3 (AVX2); GCC 12.2.0.

| scene | ranks | samples | room | instructions | D1 misses | LL read misses | LL write misses |
|---|---|---|---|---|---|---|---|
| tree | 1 | 16,000 | tracing | $1 | $2 | 1.86 | 0.00 |
| tree, casting | 4 | 57,071 | exchange | 162 | 2.01 | 0.08 | 0.61 |
TABLE
}
printf 'Before.\n<!-- cost -->\n<!-- end -->\nBehind.\n' >page.md
table 1,447 38.48 >measured
run "$cost" --update --measured "$PWD/measured" --document "$PWD/page.md"; expect_code 0
expect_text page.md "Before.
<!-- cost -->
$(table 1,447 38.48)
<!-- end -->
Behind."

# check INSTRUCTIONS D1 CODE TEXT
check() {
  table "$1" "$2" >measured
  run "$cost" --check --measured "$PWD/measured" --document "$PWD/page.md"; expect_code "$3"
  expect_text out "$4"
}
row='tree, 1 rank, 16,000 samples, tracing'
check 1,447 38.48 0 ''
check 1,515 42.30 0 ''
check 1,380 34.70 0 ''
check 1,530 38.48 1 "$row, instructions a sample: 1530, in the table 1447: more than 5 % above"
check 1,300 38.48 1 "$row, instructions a sample: 1300, in the table 1447: more than 5 % below: update the table by scripts/cost --update"
check 1,447 45.50 1 "$row, D1 misses a sample: 45.5, in the table 38.48: more than 15 % above"

# A sequence has as many samples as it happens to make.
table 1,447 38.48 | sed 's/57,071/57,070/' >measured
run "$cost" --check --measured "$PWD/measured" --document "$PWD/page.md"; expect_code 0
table 1,447 38.48 | sed 's/57,071 | exchange | 162/57,070 | exchange | 180/' >measured
run "$cost" --check --measured "$PWD/measured" --document "$PWD/page.md"; expect_code 1
expect_text out 'tree, casting, 4 ranks, exchange, instructions a sample: 180, in the table 162: more than 5 % above'

# A row that the table lacks, and a table of another machine.
{ table 1,447 38.48; echo '| tree | 1 | 64,000 | tracing | 1 | 1.00 | 1.00 | 1.00 |'; } >measured
run "$cost" --check --measured "$PWD/measured" --document "$PWD/page.md"; expect_code 1
expect_line out 'not in the table: tree, 1 rank, 64,000 samples, tracing, instructions'
table 1,447 38.48 | sed 's/x86-64-v3 (AVX2)/another/' >measured
run "$cost" --check --measured "$PWD/measured" --document "$PWD/page.md"; expect_code 77
expect_line err 'cost: the table does not compare, it is not of: Instruction set: .*another.*'
run "$cost" --chek; expect_code 2

# Without valgrind the check is skipped, and the rest fails.
mkdir bare
for tool in bash dirname mktemp rm; do ln -s "$(command -v $tool)" bare; done
run env PATH="$PWD/bare" bash "$cost" --check; expect_code 77; expect_text err 'cost: valgrind is not installed'
run env PATH="$PWD/bare" bash "$cost"; expect_code 1
finish

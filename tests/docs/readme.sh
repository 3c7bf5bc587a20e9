#!/usr/bin/env bash
# readme.sh README SOURCE_DIR LEAST: runs the README's blocks marked "```sh runnable" in a scratch directory, one after
# the other, with the programs built on the PATH; every command must succeed. There must be LEAST commands of pprt.
# A block marked "```sh live" is one command that runs until Ctrl-C: it gets that once it has printed its address.
# Blocks marked "```sh building" are run by tests/package/builds.sh, and there are no others.
# What stands in a block "```" is a line that they print, with numbers that differ by a tenth at most.
# A script "tables" beside the README prints all of its tables from what the commands have made in the folder "study".
set -euo pipefail
readme=$1 source=$2 least=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/scenes" "$source/examples" "$scratch"
cd "$scratch/$(realpath --relative-to="$source" "$(dirname "$readme")")"
export XDG_CACHE_HOME=$scratch/cache
# For who runs mpirun as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
if others=$(grep -n '^```.' "$readme" | grep -v -e ':```sh runnable$' -e ':```sh live$' -e ':```sh building$'); then
  echo "commands that no test runs: $others"
  exit 1
fi
# until_address COMMAND...: on a port that is free, and ended as by Ctrl-C.
until_address() {
  local log=$scratch/live.log process
  set -m  # in a group of its own, as of a terminal
  "$@" 2>"$log" &
  process=$!
  set +m
  for _ in {1..300}; do
    ! grep -q 'http://' "$log" || break
    sleep 0.1
  done
  grep -q 'http://' "$log" || { cat "$log"; return 1; }
  kill -INT "$process"
  wait "$process" || { cat "$log"; return 1; }
}
awk '/^```/ { inside = ($0 == "```sh runnable"); live = ($0 == "```sh live"); next }
     inside { print }
     live { sub(/--live 8080/, "--live 0"); print "until_address " $0 }' "$readme" >"$scratch/commands.sh"
[[ $(grep -cE '^ *(until_address )?pprt-' "$scratch/commands.sh") -ge $least ]] || { echo "hardly a command to run in $readme"; exit 1; }
exec 3>&1 > >(tee "$scratch/said") 2>&1
tee=$!
set -x
source "$scratch/commands.sh"
set +x
exec >&3 2>&3 3>&-
wait "$tee"  # until it has written all

# A number may differ by a tenth, or by two of its last digit: another make of processor may take a sample more, and then
# other tiles change hands. Everything else is the same.
allowed='
  function allowed(cell) {
    gsub(/ /, "", cell)
    least = 2 / 10 ^ (index(cell, ".") ? length(cell) - index(cell, ".") : 0)
    return (cell / 10 > least ? cell / 10 : least) + 1e-9
  }'
awk "$allowed"'
  # Takes the numbers out of a line: into number[1] to number[n]. Returns what is left of it.
  function words(line, number,    left) {
    n = 0
    while (match(line, /[0-9]([0-9.,]*[0-9])?/)) {
      number[++n] = substr(line, RSTART, RLENGTH)
      gsub(/,/, "", number[n])
      left = left substr(line, 1, RSTART - 1) "#"
      line = substr(line, RSTART + RLENGTH)
    }
    return left line
  }
  NR == FNR { said[++lines] = $0; next }
  /^```/ { plain = $0 == "```" && !inside; inside = !inside; next }
  plain {
    found = 0
    for (i = 1; i <= lines && !found; ++i) {
      if (words(said[i], made) != words($0, told)) continue
      found = 1
      for (k = 1; k <= n; ++k) if ((made[k] - told[k])^2 > allowed(told[k])^2) found = 0
    }
    if (!found) { print "no command prints: " $0; failed = 1 }
  }
  END { exit failed }' "$scratch/said" "$readme"
compare_tables() {
  awk -F '|' "$allowed"'
    function is_number(cell) { return cell ~ /^ *[0-9]*\.?[0-9]+ *$/ }
    NR == FNR { made[FNR] = $0; lines = FNR; next }
    {
      cells = split(made[FNR], cell, "|")
      bad = FNR > lines || cells != NF
      for (i = 1; i <= NF && !bad; ++i) {
        if (is_number($i) && is_number(cell[i])) bad = (cell[i] - $i)^2 > allowed($i)^2
        else bad = $i != cell[i]
      }
      if (bad) { print "in the README: " $0 "\nmade:          " made[FNR]; failed = 1 }
    }
    END { exit failed || FNR != lines }' "$1" "$2"
}
if [[ -f tables ]]; then
  bash tables study | grep '^|' >"$scratch/made"
  grep '^|' "$readme" >"$scratch/told"
  compare_tables "$scratch/made" "$scratch/told" || { echo "the tables of $readme are not those of its commands"; exit 1; }
fi

#!/usr/bin/env bash
# options.sh PAGE PROGRAM [SUBCOMMAND...]: the options in the program's help, those of its subcommands
# included, are those that the manual page tags, in both directions.
set -euo pipefail
page=$1 program=$2
shift 2

# "  -s,--size WxH   What it is" -> "-s" and "--size", of the first column only.
options_in_help() {
  awk '/^  -/ {
         split($1, names, ",")
         for (i in names) { sub(/[=[].*/, "", names[i]); print names[i] }
       }'
}

# ".It Fl s , -size Ar W" -> "-s" and "--size"; mpirun's spelling "-np" counts as "--np".
options_in_page() {
  awk '$1 == ".It" {
         in_flags = 0
         for (i = 2; i <= NF; ++i) {
           if ($i == "Fl") in_flags = 1
           else if ($i ~ /^[A-Z][a-z]$/) in_flags = 0
           else if (in_flags && $i != ",") print ($i == "np" ? "--np" : "-" $i)
         }
       }' "$page"
}

help=$("$program" --help all)
for subcommand in "$@"; do help+=$'\n'$("$program" "$subcommand" --help); done
if differences=$(diff <(options_in_help <<<"$help" | sort -u) <(options_in_page | sort -u)); then exit 0; fi
echo "options in the help of $program only (<) or in $page only (>):"
grep '^[<>]' <<<"$differences"
exit 1

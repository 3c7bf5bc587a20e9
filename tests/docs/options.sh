#!/usr/bin/env bash
# options.sh PAGE PROGRAM [SUBCOMMAND...]: the options in the program's help, those of its subcommands
# included, are those that the manual page tags, in both directions. Where a tag lists an option's words, they are those
# of the help.
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

# "  --cast off|paper   Which" and ".It Fl -cast Cm off | paper" -> "--cast off|paper"
choices_in_help() { sed -nE 's/^  (-[^ ]+,)?(--[^ ]+ [a-z0-9]+(\|[a-z0-9]+)+)( .*)?$/\2/p'; }
choices_in_page() { sed -nE '/^\.It .*Fl -[^ ]+ Cm [a-z0-9]+( \| [a-z0-9]+)+$/ { s/^\.It .*Fl -([^ ]+) Cm /--\1 /; s/ \| /|/gp }' "$page"; }

help=$("$program" --help all)
for subcommand in "$@"; do help+=$'\n'$("$program" "$subcommand" --help); done
choices=$(comm -13 <(choices_in_help <<<"$help" | sort -u) <(choices_in_page | sort -u))
[[ -z $choices ]] || { printf 'words in %s that are not in the help of %s:\n%s\n' "$page" "$program" "$choices"; exit 1; }
if differences=$(diff <(options_in_help <<<"$help" | sort -u) <(options_in_page | sort -u)); then exit 0; fi
echo "options in the help of $program only (<) or in $page only (>):"
grep '^[<>]' <<<"$differences"
exit 1

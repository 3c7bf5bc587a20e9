#!/usr/bin/env bash
# links.sh SOURCE_DIR: every relative link in the Markdown files leads to a file, every file that a page names is there,
# and every decision is in the index.
set -euo pipefail
cd "$1"
failures=0
complain() { echo "$1"; failures=$((failures + 1)); }

seen=0
while IFS=: read -r file link; do
  target=${link#*](} target=${target%)} target=${target%%#*}
  case $target in '' | http:* | https:* | mailto:*) continue ;; esac
  seen=$((seen + 1))
  [[ -e $(dirname "$file")/$target ]] || complain "$file: $target is not there"
done < <(grep -roE '\]\([^) ]+\)' ./*.md docs --include='*.md')
[[ $seen -gt 5 ]] || complain "only $seen links were found"

# `parallel/exchange/mesh_exchange.cpp`, `parallel/exchange` or `parallel/exchange.*`: below src or the root, if that has such a room.
seen=0
# shellcheck disable=SC2016 # backquotes are meant
while IFS=: read -r file name; do
  name=${name//\`/} stem=${name%.\*} found=
  [[ ${name%%/*} != build && (-d ${name%%/*} || -d src/${name%%/*}) ]] || continue
  seen=$((seen + 1))
  for place in "$name" "src/$name" "src/$stem.h" "src/$stem.cpp"; do [[ ! -e $place ]] || found=$place; done
  [[ -n $found ]] || complain "$file: $name is not there"
done < <(grep -oE '`[a-z_]+/[a-z_0-9/]*(\.[a-z*]+)?`' ./*.md docs/*.md)
[[ $seen -gt 50 ]] || complain "only $seen names of files were found"

for decision in docs/decisions/[0-9]*.md; do
  grep -qF "(${decision##*/})" docs/decisions/README.md ||
    complain "docs/decisions/README.md: does not list ${decision##*/}"
done
[[ $failures -eq 0 ]]

#!/usr/bin/env bash
# losses.sh SOURCE_DIR: pprt-convert(1) has what is told of models, word by word.
set -euo pipefail
cd "$1"
page=$(grep -v '^\.It$' man/pprt-convert.1 | tr '\n' ' ')
rows=$(sed -n 's/^ .*"\(.*\)"},$/\1/p' src/convert/model/model_losses.h)
[[ $(wc -l <<<"$rows") -gt 10 ]] || { echo 'model_losses.h: its rows were not found'; exit 1; }
failures=0
while read -r row; do
  [[ $page == *" $row "* ]] || { echo "man/pprt-convert.1 lacks: $row"; failures=1; }
done <<<"$rows"
exit $failures

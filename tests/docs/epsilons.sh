#!/usr/bin/env bash
# epsilons.sh SOURCE_DIR: docs/numerics.md names every small constant of the sources that pictures depend on, by name and
# file. Times and prices are none.
set -euo pipefail
cd "$1"
failures=0 seen=0
constants=$(grep -roE 'k[A-Z][A-Za-z]+ = ([0-9.]+ \* )?(0x[0-9.]+p-|[0-9.]+e-)[0-9]+' \
  src/{base,scene,parser,trace,pipeline} src/parallel/rank --include='*.h' --include='*.cpp')
while IFS=: read -r file constant; do
  name=${constant%% *} place=${file#src/}
  seen=$((seen + 1))
  # A name that several files have is told with its file.
  if [[ $(grep -o ":$name = " <<<"$constants" | wc -l) -eq 1 ]]; then place='|'; fi
  if grep -F "\`$name\`" docs/numerics.md | grep -qF "$place"; then continue; fi
  echo "$file: docs/numerics.md does not name $name"
  failures=$((failures + 1))
done <<<"$constants"
[[ $seen -ge 20 ]] || { echo "only $seen constants were found"; exit 1; }
[[ $failures -eq 0 ]]

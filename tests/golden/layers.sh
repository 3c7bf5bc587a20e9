#!/usr/bin/env bash
# layers.sh RANKS|control EVIDENCE_DIR: compares the pictures of layers with the approved ones. "control" renders on 3
# ranks without reflection; it fails unless the comparison with those of 4 ranks notices. When the comparison fails, the
# rendered pictures and the differences are kept in EVIDENCE_DIR.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/lib.sh"
mode=$1 evidence=$2
mkdir -p "$evidence"
failures=0

while read -r layer max_rmse max_share; do
  actual=$evidence/layer-$layer-$mode-actual.png diff=$evidence/layer-$layer-$mode-diff.png
  if [[ $mode == control ]]; then
    approved=$here/reference/layer-$layer-4.png
    golden_layer_picture "$layer" 3 "$actual" --max-depth 1
  else
    approved=$here/reference/layer-$layer-$mode.png
    golden_layer_picture "$layer" "$mode" "$actual"
  fi
  code=0
  pprt-compare "$actual" "$approved" --threshold $golden_threshold --max-rmse "$max_rmse" --max-share "$max_share" \
    --diff "$diff" || code=$?
  if [[ $mode == control && $code == 1 || $mode != control && $code == 0 ]]; then
    rm -f "$actual" "$diff"
    continue
  fi
  failures=$((failures + 1))
  if [[ $mode == control ]]; then
    echo "golden: fewer ranks and no reflection went unnoticed in $layer (pprt-compare's exit code was $code)" >&2
  else
    echo "golden: rendered $actual, approved $approved, difference $diff" >&2
    echo "golden: if the new picture is right: scripts/approve-goldens layers" >&2
  fi
done < <(golden_layers)
[[ $failures -eq 0 ]]

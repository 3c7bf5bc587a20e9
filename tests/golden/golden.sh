#!/usr/bin/env bash
# golden.sh RANKS|control SCENE MAX_RMSE MAX_SHARE EVIDENCE_DIR: compares a scene's picture with the approved one.
# "control" moves the scene's lights by half their distance; it fails unless the comparison notices.
# When the comparison fails, the rendered picture and the difference are kept in EVIDENCE_DIR.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/lib.sh"
mode=$1 scene=$2 max_rmse=$3 max_share=$4 evidence=$5

name=$(golden_name "$scene")
mkdir -p "$evidence"
actual=$evidence/$name-$mode-actual.png diff=$evidence/$name-$mode-diff.png
ranks=$mode
if [[ $mode == control ]]; then
  ranks=1
  pprt-convert "$scene" "$evidence/$name.nff"
  awk '/^l / { $2 += sqrt($2 * $2 + $3 * $3 + $4 * $4) / 2 } { print }' "$evidence/$name.nff" \
    >"$evidence/$name-moved.nff"
  scene=$evidence/$name-moved.nff
fi
golden_picture "$scene" "$ranks" "$actual"

code=0
pprt-compare "$actual" "$here/reference/$name.png" --threshold $golden_threshold --max-rmse "$max_rmse" \
  --max-share "$max_share" --diff "$diff" || code=$?
if [[ $mode == control ]]; then
  rm -f "$evidence/$name.nff" "$evidence/$name-moved.nff"
  if [[ $code == 1 ]]; then
    rm -f "$actual" "$diff"
    exit 0
  fi
  echo "golden: the moved lights went unnoticed (pprt-compare's exit code was $code)" >&2
  exit 1
fi
if [[ $code == 0 ]]; then
  rm -f "$actual" "$diff"
  exit 0
fi
echo "golden: rendered:   $actual" >&2
echo "golden: approved:   $here/reference/$name.png" >&2
echo "golden: difference: $diff" >&2
echo "golden: if the new picture is right: scripts/approve-goldens $name" >&2
exit 1

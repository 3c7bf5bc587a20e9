#!/usr/bin/env bash
# golden.sh RANKS|control EVIDENCE_DIR SCENE MAX_RMSE MAX_SHARE [EFFECT...]: compares a scene's picture with the approved
# one. "control" fails unless the comparison notices each of its changes. It moves the lights of a database by half their
# distance. The suns of a file it lets shine from the other side, and it renders it without each of the effects named.
# When the comparison fails, the rendered picture and the difference are kept in EVIDENCE_DIR.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/lib.sh"
mode=$1 evidence=$2 scene=$3 max_rmse=$4 max_share=$5
effects=("${@:6}")
name=$(golden_name "$scene")
actual=$evidence/$name-$mode-actual.png diff=$evidence/$name-$mode-diff.png
mkdir -p "$evidence"

# is_approved SOURCE RANKS [OPTION...]: leaves the picture, and the difference, where it is not.
is_approved() {
  local code=0
  golden_picture "$1" "$2" "$actual" "${@:3}"
  pprt-compare "$actual" "$here/reference/$name.png" --threshold $golden_threshold --max-rmse "$max_rmse" \
    --max-share "$max_share" --diff "$diff" || code=$?
  [[ $code -le 1 ]] || { echo "golden: pprt-compare's exit code was $code" >&2; exit 1; }
  [[ $code -ne 0 ]] || rm -f "$actual" "$diff"
  return $code
}
# must_differ WHAT SOURCE [OPTION...]
must_differ() {
  if is_approved "$2" 1 "${@:3}"; then
    echo "golden: $1 went unnoticed" >&2
    exit 1
  fi
  rm -f "$actual" "$diff"
}

if [[ $mode != control ]]; then
  if is_approved "$(golden_source "$scene")" "$mode"; then exit 0; fi
  echo "golden: rendered:   $actual" >&2
  echo "golden: approved:   $here/reference/$name.png" >&2
  echo "golden: difference: $diff" >&2
  echo "golden: if the new picture is right: scripts/approve-goldens $name" >&2
  exit 1
fi
changed=$(mktemp -d)
trap 'rm -rf "$changed"' EXIT
if [[ $scene == spd:* ]]; then
  pprt-convert "$scene" "$changed/scene.nff"
  awk '/^l / { $2 += sqrt($2 * $2 + $3 * $3 + $4 * $4) / 2 } { print }' "$changed/scene.nff" >"$changed/moved.nff"
  must_differ "the moved lights" "$changed/moved.nff"
  exit
fi
cp -r "$(dirname "$(golden_source "$scene")")/." "$changed"
sed -i -E 's/(\<ls |\<sun \{ from <)-/\1/' "$changed/${scene##*/}"
must_differ "the suns on the other side" "$changed/${scene##*/}"
all=$(IFS=,; echo "${effects[*]}")
for effect in "${effects[@]}"; do
  others=${all/$effect/} others=${others/,,/,} others=${others#,}
  must_differ "the lack of $effect" "$(golden_source "$scene")" --effects "${others%,}"
done

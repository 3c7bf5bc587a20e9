#!/usr/bin/env bash
# score.sh FILE...: prints the outcome of each NFF file, one per line: "NAME PPRT TACHYON".
#
#   as-plain         the picture of plain.nff, to the last bit
#   picture          exit 0, and more than one colour
#   one-colour-told  exit 0, one colour, and a warning that says so
#   refused          exit 3 and a message; no file is left
#   BLANK            exit 0 and one colour without a warning
#   FAILED-CODE      anything else
#
# Outcomes of Tachyon, another NFF reader: picture, blank, failed; "-" where it is not installed.
# Needs pprt-render, pprt-compare and count_colors on the PATH.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# picture_of SCENE FILE
picture_of() { timeout 20 pprt-render "$1" -s 48x48 --samples 600 --clock work --progress none --overwrite -o "$2"; }

ours() {
  local code=0 picture=$scratch/ours.png
  rm -f "$picture"
  picture_of "$1" "$picture" 2>"$scratch/told" || code=$?
  case $code in
    0)
      if pprt-compare "$picture" "$scratch/plain.png" --max-error 0 &>/dev/null; then echo as-plain
      elif [[ $(count_colors "$picture") -gt 1 ]]; then echo picture
      elif grep -q 'of one colour throughout' "$scratch/told"; then echo one-colour-told
      else echo BLANK; fi
      ;;
    3) if [[ -s $scratch/told && ! -e $picture ]]; then echo refused; else echo FAILED-3; fi ;;
    *) echo "FAILED-$code" ;;
  esac
}

tachyons() {
  local picture=$scratch/theirs.png
  rm -f "$picture"
  command -v tachyon >/dev/null || { echo -; return; }
  # It may also ask for gigabytes.
  if (ulimit -v 4000000; timeout 20 tachyon "$1" -res 48 48 -format PNG -o "$picture") &>/dev/null && [[ -s $picture ]]
  then
    if [[ $(count_colors "$picture") -gt 1 ]]; then echo picture; else echo blank; fi
  else
    echo failed
  fi
}

picture_of "$here/plain.nff" "$scratch/plain.png"
for file in "$@"; do
  name=${file##*/}
  echo "${name%.nff} $(ours "$file") $(tachyons "$file")"
done

#!/usr/bin/env bash
# resume.sh RANKS SCENE BUDGET OPTIONS...: in counted time, a run that goes on makes the files that an undisturbed
# one makes, bit by bit, and only those that are missing.
source "$(dirname "$0")/lib.sh"
ranks=$1 scene=$2 budget=$3
shift 3

render() {
  pprt-render "$scene" "$here/moving.anim" --frames 3-24 -np "$ranks" --clock work --budget "$budget" \
    --progress none -o 'out/%04d.exr' -o 'out/%04d.png' "$@"
}

render "$@"
cp -rp out undisturbed
# Within the first move, at the end of it, and behind the cut.
rm out/0010.png out/0011.exr out/0018.png out/0021.png out/0022.exr out/0022.png
touch -d '1 hour ago' out/*.png out/*.exr
render "$@" --resume
for file in undisturbed/*.{exr,png}; do
  cmp "$file" "out/${file##*/}" || fail "${file##*/} differs from that of an undisturbed run"
done
made=$(find out -name '*.png' -newer undisturbed/manifest.ndjson -mmin -30 | wc -l)
[[ $made == 5 ]] || fail "$made pictures were made where 5 were missing"
# Behind the cut alone: what was before it has left no trace.
if [[ $ranks == 1 || " $* " == *" --balance none "* ]]; then
  rm out/0019.exr out/0020.exr out/0022.png out/0024.exr
  render "$@" --resume
  for file in undisturbed/*.{exr,png}; do
    cmp "$file" "out/${file##*/}" || fail "${file##*/}, behind the cut, differs from that of an undisturbed run"
  done
fi
# Nothing is missing: nothing is made.
touch -d '1 hour ago' out/*.png out/*.exr
render "$@" --resume
[[ -z $(find out -name '0*' -mmin -30) ]] || fail "pictures were made again that were there"

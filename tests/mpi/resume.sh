#!/usr/bin/env bash
# resume.sh RANKS SCENE BUDGET OPTIONS...: under the work clock a resumed run writes the missing files only, equal to
# those of an undisturbed run to the byte.
source "$(dirname "$0")/lib.sh"
ranks=$1 scene=$2 budget=$3
shift 3

render() {
  pprt-render "$scene" "$here/moving.anim" --frames 3-24 -np "$ranks" --clock work --budget "$budget" \
    --progress none -o 'out/%04d.exr' -o 'out/%04d.png' "$@"
}

render "$@"
cp -rp out undisturbed
# Within the first movement, at its end, and after the cut.
rm out/0010.png out/0011.exr out/0018.png out/0021.png out/0022.exr out/0022.png
touch -d '1 hour ago' out/*.png out/*.exr
render "$@" --resume
for file in undisturbed/*.{exr,png}; do
  cmp "$file" "out/${file##*/}" || fail "${file##*/} differs from that of an undisturbed run"
done
made=$(find out -name '*.png' -newer undisturbed/manifest.ndjson -mmin -30 | wc -l)
[[ $made == 5 ]] || fail "$made pictures were made where 5 were missing"
# After the cut: the frames before it must make no difference.
if [[ $ranks == 1 || " $* " == *" --balance none "* ]]; then
  rm out/0019.exr out/0020.exr out/0022.png out/0024.exr
  render "$@" --resume
  for file in undisturbed/*.{exr,png}; do
    cmp "$file" "out/${file##*/}" || fail "${file##*/}, after the cut, differs from that of an undisturbed run"
  done
fi
# Nothing is missing, so nothing is written.
touch -d '1 hour ago' out/*.png out/*.exr
render "$@" --resume
[[ -z $(find out -name '0*' -mmin -30) ]] || fail "pictures were made again that were there"

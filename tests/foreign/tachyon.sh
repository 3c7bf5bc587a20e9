#!/usr/bin/env bash
# tachyon.sh SCENE check|control: Tachyon reads the .nff of pprt-convert and hits objects where pprt does, in all but
# 0.05 % of the pixels. Tachyon ignores the file's field of view and has its own. "control" keeps the file's in pprt; it
# fails unless that is noticed.
set -euo pipefail
scene=$1 mode=$2 size=256
command -v tachyon >/dev/null || { echo "tachyon is not installed"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# White on black; the upper edge at the tangent 1/2, half a pixel beyond the centres of the first row.
angle=$(awk -v n=$size 'BEGIN { printf "%.9f", 2 * atan2(0.5 * (n - 1) / n, 1) * 180 / 3.14159265358979 }')
pprt-convert "$scene" scene.nff
sed -i 's/^f .*/f 1 1 1 1 0 0 0 1/; s/^b .*/b 0 0 0/' scene.nff
[[ $mode == control ]] || sed -i "s/^angle .*/angle $angle/" scene.nff
tachyon scene.nff -res $size $size -lowestshade -format PNG -o theirs.png >tachyon.txt 2>&1 || { cat tachyon.txt; exit 1; }
pixel_rays scene.nff $size ours.png shaded.png tachyon >rays.txt

code=0
pprt-compare theirs.png ours.png --threshold 0.5 --max-share 0.0005 >figures.txt || code=$?
echo "$scene: share of pixels in which one sees something, the other nothing: $(awk '$1 == "share" { print $2 }' figures.txt)"
case $mode in
  check) [[ $code -eq 0 ]] ;;
  control) [[ $code -eq 1 ]] || { echo "another field of view went unnoticed"; exit 1; } ;;
esac

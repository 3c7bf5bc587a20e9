#!/usr/bin/env bash
# pov.sh SCENE SIZE MAX_SHADOW_DIFFERENCE MAX_RMSE check|control: compares POV-Ray's picture of a converted scene with
# pixel_rays. First hits may differ in 0.2 % of the pixels, the number of shadow rays by MAX_SHADOW_DIFFERENCE per cent.
# "SCENE@INDEX" sets the refractive index of the scene's glass. "control" mirrors the camera and removes a light; it
# fails unless both are noticed.
set -euo pipefail
scene=$1 size=$2 max_shadow=$3 max_rmse=$4 mode=$5
command -v povray >/dev/null || { echo "povray is not installed"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# render IN OUT OPTION...: statistics go to the file OUT.err.
render() {
  povray +I"$1" +O"$2" +W"$size" +H"$size" -A -D +FN8 "${@:3}" >/dev/null 2>"$2.err" || { cat "$2.err"; exit 1; }
}

pprt-convert "${scene%@*}" scene.nff
[[ $scene != *@* ]] || sed -i "s/^\(f.*\) [^ ]*$/\1 ${scene#*@}/" scene.nff
pprt-convert scene.nff scene.pov
our_shadows=$(pixel_rays scene.nff "$size" flat.png shaded.png)
if [[ $mode == control ]]; then
  sed -i 's/^  right /&-1 * /; 0,/^light_source/{/^light_source/d}' scene.pov
fi
# Quality 0 shows plain, opaque colours; a miss is black.
sed 's/^background .*/background { rgb <0, 0, 0> }/' scene.pov >plain.pov
render plain.pov pov_flat.png +Q0
render scene.pov pov_shaded.png

failures=0
shadows=$(awk '/^Shadow Ray Tests:/ { print $4 }' pov_shaded.png.err)
difference=$(awk -v a="${shadows:-0}" -v b="$our_shadows" 'BEGIN { printf "%.3f", 100 * (a - b) / b }')
pprt-compare pov_flat.png flat.png --threshold 0.02 --max-share 0.002 >flat.txt || failures=$((failures + 1))
pprt-compare pov_shaded.png shaded.png --threshold 0.02 --max-rmse "$max_rmse" >shaded.txt || failures=$((failures + 1))
awk -v d="$difference" -v m="$max_shadow" 'BEGIN { exit d < -m || d > m }' || failures=$((failures + 1))

echo "$scene: share of pixels that see another thing: $(awk '$1 == "share" { print $2 }' flat.txt)"
echo "$scene: shadow rays: POV-Ray ${shadows:-0}, pprt $our_shadows ($difference %)"
echo "$scene: shaded: rmse $(awk '$1 == "rmse" { print $2 }' shaded.txt), share over 0.02: $(awk '$1 == "share" { print $2 }' shaded.txt)"
case $mode in
  check) [[ $failures -eq 0 ]] ;;
  control) [[ $failures -eq 3 ]] || { echo "only $failures of 3 faults were noticed"; exit 1; } ;;
esac

#!/usr/bin/env bash
# pov_aff.sh check|control FAULT: compares POV-Ray's picture of a converted AFF scene with pixel_rays, at a time between
# its keys. It has textures with v running down, a tinted and a transparent one, a colour for each term, a stretched
# ball, a light that moves, lamps with and without a picture, a sun and a sky. "control" puts in a FAULT, which must be noticed.
set -euo pipefail
mode=$1 fault=${2:-}
command -v povray >/dev/null || { echo "povray is not installed"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# 5 x 3 texels of distinct colours.
{
  printf 'P3\n5 3\n255\n'
  awk 'BEGIN { for (i = 0; i < 45; ++i) print (i * 97 + i * i * 13) % 256 }'
} >spots.ppm
cat >scene.aff <<'SCENE'
v from 0 1 8 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 256 256
b .1 .2 .3  bs .2 1 -.3 .6 .5 .4 .1 .2 .5  am 2 1.5 1  a 0 4 9
ls 1 2 3 .2 .25 .2
la lamp 0 0 0 .5 .4 .3  l -5 5 6 .3 .3 .4
fm .1 .2 .1 .6 .6 .6 .1 .1 .1 20 0 0
m vertices 4 -2.6 -2 -1 -.1 -2 -1 -.1 2 -1 -2.6 2 -1
  texturecoords 4 spots.ppm -.3 1.3 1.4 1.3 1.4 -.2 -.3 -.2 triangles 2 0 1 2 0 1 2 0 2 3 0 2 3
fm .1 .2 .1 .8 .4 .2 0 0 0 0 0 0 fet spots.ppm .1 .2 .3
m vertices 4 .1 -2 -1 2.6 -2 -1 2.6 2 -1 .1 2 -1 normals 1 0 0 1
  texturecoords 4 spots.ppm 0 1 1 1 1 0 0 0 triangles 2 0 1 2 0 0 0 0 1 2 0 2 3 0 0 0 0 2 3
fm .05 .1 .05 .3 .3 .3 0 0 0 0 .5 1
m vertices 3 -1.5 -1.5 .5 1.5 -1.5 .5 0 0 .5
  texturecoords 3 spots.ppm 0 1 1 1 .5 0 triangles 1 0 1 2 0 1 2
fm .1 0 .2 0 .5 .7 .3 .2 .1 0 0 0
xs .8 .3 .5 0 0 1 30 1 .8 .2 { s 0 0 0 1 }
fm .3 0 0 .5 .2 0 .3 .2 0 30 0 0
x ball { c 0 0 0 .4 0 1 0 .1 }
fm .1 .1 .1 .2 .2 .2 0 0 0 0 0 0 fe .3 .1 .2 s 0 -1.2 1.5 .3
fet spots.ppm .6 .5 .4 m vertices 3 -.5 1.2 1 .5 1.2 1 0 1.9 1 texturecoords 3 - 0 1 1 1 .5 0 triangles 1 0 1 2 0 1 2
k ball { transl 4 0 -2 .5 1 0 0 0 1 -1.5 .5 1 0 0 0 3 -.5 1 1 0 0 0 4 0 1 1 0 0 0 }
k lamp { transl 4 0 2 3 5 0 0 0 1 2 3 5 0 0 0 3 4 3 5 0 0 0 4 5 3 5 0 0 0 }
SCENE

pprt-convert --at 2 scene.aff scene.pov 2>told.txt
[[ ! -s told.txt ]] || { cat told.txt; exit 1; }  # all of it can be written
pixel_rays scene.aff 256 flat.png ours.png 2 >/dev/null
case $fault in
  flipped) sed -i 's/\(image_map .*\) }$/\1 scale <1, -1, 1> }/' scene.pov ;;
  coarse) sed -i 's/ interpolate 2//' scene.pov ;;
  early) pprt-convert scene.aff scene.pov ;;
  white) sed -i '/^texture {/,/^}/d' scene.pov ;;
  dark) sed -i 's/ emission .* }$/ }/' scene.pov ;;
  sunless) sed -i '/ parallel /d' scene.pov ;;
  skyless) sed -i '/^sky_sphere/d' scene.pov ;;
  round) sed -i 's/ matrix <[^>]*>//' scene.pov ;;
esac
povray +Iscene.pov +Opov.png +W256 +H256 -A -D +FN8 >/dev/null 2>pov.err || { cat pov.err; exit 1; }
failed=0
pprt-compare pov.png ours.png --threshold 0.02 --max-rmse 0.004 --max-share 0.002 >figures.txt 2>limits.txt || failed=1
[[ -s figures.txt ]] || { cat limits.txt; exit 1; }
echo "rmse $(awk '$1 == "rmse" { print $2 }' figures.txt), share over 0.02: $(awk '$1 == "share" { print $2 }' figures.txt)"
case $mode in
  check) [[ $failed -eq 0 ]] ;;
  control) [[ $failed -eq 1 ]] || { echo "the fault was not noticed"; exit 1; } ;;
esac

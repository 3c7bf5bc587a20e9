#!/usr/bin/env bash
# Values that no picture holds do not end a run: they are clamped, or refused in words before it begins.
source "$(dirname "$0")/check.sh"
view=$'v\nfrom 0 -5 2\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.1\nresolution 32 32\n'
objects=$'l 3 -4 6\nf .8 .3 .2 .8 .1 10 0 1\ns 0 0 0 1\n'

# Colours near the end of float, of either sign: their differences and sums would exceed it.
for background in '3e38 0 0' '3e38 3e38 0' '-3e38 3e38 3' '3.4e38 0 3.4e38'; do
  printf '%sb %s\n%s' "$view" "$background" "$objects" >bright.nff
  for sampler in auto delaunay grid; do
    run pprt-render bright.nff --sampler $sampler --samples 3000 --overwrite -o b.png -o b.exr
    expect_code 0
  done
done
run pprt-compare b.exr b.exr; expect_code 0

# What float cannot hold is as bright as what it just holds.
for background in '3e38 3e38 3e38' '1e39 1e60 1e300'; do
  printf '%sb %s\n%s' "$view" "$background" "$objects" >bright.nff
  run pprt-render bright.nff --samples 3000 --clock work -o "${background%% *}.exr"; expect_code 0
done
run pprt-compare 3e38.exr 1e39.exr --max-error 0; expect_code 0

# The eye lies in the plane of a polygon, where depths are 0.
printf '%s' $'v\nfrom 0 0 0\nat 0 1 0\nup 0 0 1\nangle 45\nhither 0.1\nresolution 16 16\nb .1 .2 .4\n' "${objects/s 0 0 0/s 0 3 0}" \
  $'p 4\n-5 -5 0\n5 -5 0\n5 5 0\n-5 5 0\n' >plane.nff
run pprt-render plane.nff --samples 500 -o plane.png -o plane.exr --layers all; expect_code 0

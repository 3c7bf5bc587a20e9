#!/usr/bin/env bash
# same_pictures.sh stills|frames|moving LIBRARY SCENES: pictures under the work clock do not depend on the instruction set
# that Embree uses, nor on whether libm uses fused multiply-adds. LIBRARY holds Embree (hold_embree.cpp).
source "$(dirname "$0")/../mpi/lib.sh"
kind=$1 library=$2 scenes=$3

# render DIRECTORY
render() {
  local name sampler
  mkdir "$1"
  case $kind in
    stills)
      for name in balls gears jacks lattice mount rings teapot tetra tree; do
        for sampler in auto delaunay; do
          pprt-render "spd:$name" -s 128x128 --sampler "$sampler" --clock work --samples 6000 --progress none \
            -o "$1/$name-$sampler.exr"
        done
      done ;;
    frames)
      pprt-render "$scenes/tree-casting.anim" --frames 1-4 -np 4 -s 256x256 --clock work --progress none -o "$1/%d.exr" ;;
    moving)
      for name in carousel.aff cloth.aff rolling-ball.aff turning-pyramid.anim; do
        pprt-render "$scenes/$name" --frames 1-4 -s 160x120 --clock work --samples 8000 --progress none \
          -o "$1/${name%.*}-%d.exr"
      done ;;
  esac
}

# pictures_of DIRECTORY: checksums of the pixels, in the order of the names. What else an EXR's header tells, such as counts
# of rays, may differ.
pictures_of() {
  (cd "$1" && ls -- *.exr)
  ffmpeg -v error -pattern_type glob -i "$1/*.exr" -pix_fmt gbrpf32le -f framehash - | grep -v '^#'
}

# A set that the processor lacks falls back to the best that it has.
render plain
pictures_of plain >plain.sums
pictures=$(grep -c , plain.sums)
[[ $pictures -ge 4 && $pictures -eq $(grep -c exr plain.sums) ]] || fail 'no pictures'
for set in sse4.2 avx2 avx512; do
  LD_PRELOAD=$library PPRT_HOLD_EMBREE=isa=$set render "embree-$set"
  pictures_of "embree-$set" | diff plain.sums - || fail "Embree held to $set shows something else"
done
GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F render libm
pictures_of libm | diff plain.sums - || fail 'libm without fused multiply-adds shows something else'

# The library does hold Embree, which then tells so.
LD_PRELOAD=$library PPRT_HOLD_EMBREE=isa=sse4.2,verbose=1 pprt-render spd:tree:2 -s 16x16 --clock work --samples 100 \
  -o x.png >told 2>&1
sed -n '/Config/,$p' told | grep -m 1 'ISA ' | grep SSE4.2 | grep -qv AVX || fail "Embree was not held: $(cat told)"

#!/usr/bin/env bash
# Scenes in AFF: what moves, textures, and how they are refused.
here=$(cd "$(dirname "$0")" && pwd)
source "$here/check.sh"

cat >toy.aff <<'AFF'
v from 0 3 9 at 0 1 0 up 0 1 0 angle 40 hither 1 resolution 48 36
am 1 1 1 b .2 .3 .4 l 4 8 6 .7 .7 .7 a 1 2 6
fm .2 .2 .2 .7 .7 .7 0 0 0 0 0 1
tt floor.ppm -6 0 6 0 1 6 0 6 1 1 0 0 -6 0.5 0
i 0 part.aff
AFF
cat >part.aff <<'AFF'
fm .1 0 0 .7 .2 .1 .2 .2 .2 20 0 1
x ball { s 0 .7 0 .7 }
k ball { transl 4 0 -3 0 0 0 0 0 1 -2 0 0 0 0 0 2 2 0 0 0 0 0 3 3 0 0 0 0 0 }
AFF

# The pictures: beside the scene, in TextureFiles/ there, or in ../TextureFiles/.
missing="toy.aff:4:1: error: there is no texture 'floor.ppm' beside the scene, in TextureFiles/ or in ../TextureFiles/"
run pprt-render toy.aff; expect_code 3; expect_text err "$missing"
mkdir TextureFiles
printf 'P6 2 2 255\n\377\0\0\0\377\0\0\0\377\377\377' >TextureFiles/floor.ppm
run pprt-render toy.aff; expect_code 3
expect_text err "toy.aff:4:1: error: cannot read 'TextureFiles/floor.ppm': the file ends early"
printf 'P6 2 2 255\n\377\0\0\0\377\0\0\0\377\377\377\377' >TextureFiles/floor.ppm

run pprt-render toy.aff --census; expect_code 0
expect_line out 'primitives  1 sphere, 1 triangle'
expect_line out 'movement    1 object that moves'
expect_line out '  textures        yes  1 material with a texture'

# Frames and their times come from the scene; ranks and threads make no difference that has no reason.
run pprt-render toy.aff --clock work -o 'a%d.png'; expect_code 0
for n in 1 2 3 4 5 6; do expect_file a$n.png; done
run pprt-render toy.aff --frames 3-4 --clock work --samples 3000 --cast off -o 'b%d.png'; expect_code 0
run pprt-render -np 3 toy.aff --frames 3-4 --clock work --samples 3000 --cast off -o 'c%d.png'; expect_code 0
run pprt-compare b3.png c3.png --max-rmse 0.02; expect_code 0
run pprt-compare b3.png c4.png --max-rmse 0.02; expect_code 1
for i in 1 2; do
  run pprt-render -np 2 --threads 2 toy.aff --clock work --fps 8 --overwrite -o "r$i-%d.png"; expect_code 0
done
for n in 1 3 6; do expect_same r1-$n.png r2-$n.png; done
run pprt-compare r1-2.png r1-5.png --max-rmse 0.02; expect_code 1

# AFF holds all of it: the same bytes. By way of glTF it moves as well, in a material of that format's.
run pprt-convert toy.aff kept.aff; expect_code 0; expect_same err /dev/null; expect_file kept-floor.png
run pprt-render kept.aff --clock work -o 'k%d.png'; expect_code 0
for n in 1 3 6; do expect_same a$n.png k$n.png; done
cmp -s a3.png k6.png && complain 'another frame is the same'
run pprt-convert toy.aff toy.glb; expect_code 0; expect_line err 'toy.aff: the ambient light is not kept'
run pprt-convert toy.glb back.aff; expect_code 0
expect_text err 'toy.glb: 1 material with coloured glass or metal: what is seen through or in it keeps its colours
toy.glb: 1 light that weakens with the distance: it is as bright everywhere as in the middle of the scene'
run pprt-render back.aff --census; expect_code 0; expect_line out 'movement    1 object that moves'
run pprt-convert --at 1.5 toy.aff still.aff; expect_code 0
run pprt-render still.aff --census; expect_code 0
grep -q movement out && complain 'a scene at one time moves'

# A script names the scene: its frames are spread over the scene's time, and the camera is its own.
echo 'animation { scene "toy.aff" frames 2 }' >toy.anim
run pprt-render toy.anim --clock work --samples 3000 --cast off -o 's%d.png'; expect_code 0
run pprt-render toy.aff --frames 6-6 --clock work --samples 3000 --cast off -o e.png; expect_code 0
run pprt-compare s2.png e.png --max-rmse 0.001; expect_code 0
run pprt-compare s1.png e.png --max-rmse 0.02; expect_code 1

# Problems of every file, each with its place.
echo 'fm 1 2 x' >>part.aff; echo 's 0 0' >>toy.aff
run pprt-render toy.aff; expect_code 3
expect_line err "toy.aff:6:6: error: expected .*"
expect_line err "part.aff:4:8: error: expected a number for blue of the ambient colour of 'fm', found 'x'"
mkdir inner; cp toy.aff part.aff inner; cp inner/part.aff outside.aff
printf 'i 0 ../outside.aff\n' >inner/bad.aff
run pprt-render inner/bad.aff; expect_code 3
expect_line err ".*the file lies outside the scene's folder"

# Scripts move other scenes, and parts of this one by name.
cat >moves.anim <<'ANIM'
animation { scene "ball.nff" frames 4 fps 4
  object "other.nff" { key 1 { scale .5 translate <-2, 0, 0> } key 4 { translate <2, 0, 0> rotate <0, 0, 360> } }
}
ANIM
run pprt-render moves.anim --fps 0 --samples 2000 --cast off --clock work -o 'm%d.png'; expect_code 3
expect_line err "moves.anim:2:11: error: cannot read 'other.nff': No such file or directory"
printf 'f 1 0 0 1 0 0 0 0\ns 0 0 3 1\n' >other.nff
run pprt-render moves.anim --fps 0 --samples 2000 --cast off --clock work -o 'm%d.png'; expect_code 0
run pprt-compare m1.png m4.png --max-rmse 0.01; expect_code 1
run pprt-render moves.anim --census; expect_line out 'movement    1 object that moves'
sed -i '$d' toy.aff; sed -i '$d' part.aff
echo 'animation { scene "toy.aff" frames 2 object "ball" { key 1 { translate <0, 3, 0> } } }' >named.anim
run pprt-render named.anim --clock work --samples 3000 --cast off -o 'n%d.png'; expect_code 0
run pprt-compare n1.png n2.png; expect_code 0
run pprt-compare n2.png e.png --max-rmse 0.02; expect_code 1

# A scene of one moment has no time of its own for a script's frames.
sed 's/a 1 2 6/a 1 1 1/' toy.aff >moment.aff
echo 'animation { scene "moment.aff" frames 5 fps 4 object "ball" { key 1 {} key 5 { translate <0, 3, 0> } } }' >moment.anim
run pprt-render moment.anim --fps 0 --clock work --samples 3000 --cast off -o 'o%d.png'; expect_code 0
run pprt-compare o1.png o5.png --max-rmse 0.02; expect_code 1
echo 'animation { scene "toy.aff" frames 1000000 object "ball" {} object "a.nff" {} object "b.nff" {} object "c.nff" {}
  object "d.nff" {} object "e.nff" {} }' >many.anim
for name in a b c d e; do cp other.nff $name.nff; done
run pprt-render many.anim; expect_code 3
expect_line err 'many.anim:2:[0-9]*: error: too many objects for so many frames: objects times frames, here 6 times 1000000, may be 5000000 at most'

# The scenes of the distribution: without a warning, and they move.
shown=0
for scene in "$here"/../../scenes/*.aff; do
  name=$(basename "$scene" .aff)
  run pprt-render "$scene" --frames 10-40 --clock work --fps 8 -s 48x32 --overwrite -o "$name-%d.png"; expect_code 0
  expect_line err "done: 31 of 31 frames in .*"
  [[ $(wc -l <err) -eq 1 ]] || complain "$name: it said more: $(cat err)"
  run pprt-compare "$name-10.png" "$name-40.png" --max-rmse 0.01; expect_code 1
  shown=$((shown + 1))
done
[[ $shown -gt 1 ]] || complain "there are $shown scenes"

# A frame of a million, with thousands of objects that move and a hundred thousand keys, is soon there. Planning each
# frame, or looking at each key for it, takes many minutes.
awk 'BEGIN {
  print "v from 0 0 30 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 16 12"
  print "am 1 1 1 b .2 .3 .4 l 4 8 6 .7 .7 .7 fm .2 .2 .2 .7 .7 .7 0 0 0 0 0 1"
  for (i = 0; i < 5000; ++i) {
    printf "x b%d { s %g %g 0 .3 }\nk b%d { transl 20", i, i % 100 / 5 - 10, i / 250 - 10, i
    for (k = 0; k < 20; ++k) printf " %d %g 0 0 0 0 0", 2000 * k, k % 3
    print " }"
  }
}' >many.aff
awk 'BEGIN {
  print "animation { scene \"many.aff\" frames 1000000 fps 25 camera {"
  print "key 1 { from <0, 0, 30> at <0, 0, 0> up <0, 1, 0> angle 45 }"
  for (i = 1; i < 100000; ++i) printf "key %d { from <%g, 0, 30> }\n", 1 + 10 * i, i % 7
  print "} }"
}' >many.anim
run timeout 120 pprt-render many.anim --frames 999999 --clock work --budget 10000 -o 'many%d.png'; expect_code 0
expect_file many999999.png
finish

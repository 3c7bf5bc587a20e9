#!/usr/bin/env bash
# pprt-render: models in place of scenes.
source "$(dirname "$0")/check.sh"

# A ball in every format, without a file between.
for extension in obj ply stl glb gltf dae; do
  pprt-convert ball.nff "mesh/ball.$extension" 2>/dev/null
  run pprt-render "mesh/ball.$extension" --clock work -s 32x32 -o "$extension.png"; expect_code 0; expect_file "$extension.png"
done

# What a model lacks is added, and told, a line each.
run pprt-render mesh/ball.stl --clock work -s 64x64 --overwrite -o grey.png; expect_code 0
expect_line err 'mesh/ball.stl: no camera: one that shows everything is added, with y up (--up z for the other)'
expect_line err 'mesh/ball.stl: no lights: a key light and a fill light are added'
expect_line err 'mesh/ball.stl: no background: a grey one is added'
run pprt-render mesh/ball.stl --up z --clock work -s 16x16 -o z.png; expect_code 0
expect_line err 'mesh/ball.stl: no camera: one that shows everything is added, with z up (--up y for the other)'

# A centimetre and a kilometre look alike.
for size in 0.005 500; do
  awk -v s=$size '$1 == "v" { $2 *= s; $3 *= s; $4 *= s } { print }' mesh/ball.obj >sized.obj; cp mesh/ball.mtl .
  run pprt-render sized.obj --clock work -s 32x32 --samples 4000 --overwrite -o sized.png; expect_code 0
  run pprt-render mesh/ball.obj --clock work -s 32x32 --samples 4000 --overwrite -o whole.png; expect_code 0
  run pprt-compare sized.png whole.png --max-rmse 0.01; expect_code 0
done

# The same picture as by a file between, but for the background.
printf 'solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid t\n' >t.stl
pprt-convert t.stl t.aff 2>/dev/null
sed -i '1,/^resolution/{/^resolution/a b 0.18 0.2 0.23
}' t.aff
run pprt-render t.stl --clock work -s 32x32 -o direct.png; expect_code 0
run pprt-render t.aff --clock work -s 32x32 -o between.png; expect_code 0
run pprt-compare direct.png between.png --max-error 0; expect_code 0

# A film turns round a model that rests; one that moves plays.
run pprt-render t.stl --clock work -s 16x16 --fps 6 --film turn.mp4 -o film/%02d.png
if command -v ffmpeg >/dev/null; then
  expect_code 0; expect_file film/24.png; expect_no_file film/25.png
  cmp -s film/01.png film/07.png && complain 'the camera does not turn'
fi

# Its second is a second at any rate.
cat >slides.aff <<'END'
a 0 1 3
v
from 0 0 5
at 0 0 0
up 0 1 0
angle 45
hither 0.1
resolution 16 16
f 1 1 1 1 0 0 0 0
x slide { s 0 0 0 0.5 }
k slide { transl 4
  -1  -3 0 0  0 0 0
  0  -1 0 0  0 0 0
  1  1 0 0  0 0 0
  2  3 0 0  0 0 0 }
END
pprt-convert slides.aff slides.glb 2>/dev/null
for rate in 6 12 24; do
  run pprt-render slides.glb --clock work -s 16x16 --fps $rate -o "at-$rate/%02d.png"; expect_code 0
  expect_line err "done: $((rate + 1)) of $((rate + 1)) frames in .*"
done

# A script names a model as its scene, and moves one.
printf 'animation {\n  scene "t.stl"\n  frames 2\n}\n' >model.anim
run pprt-render model.anim --clock work -s 16x16 -o script/%d.png; expect_code 0; expect_file script/2.png
printf 'animation {\n  scene "gone.glb"\n  frames 2\n}\n' >gone.anim
run pprt-render gone.anim --clock work -s 16x16 -o gone/%d.png; expect_code 3
expect_line err 'gone.anim:2:3: error: cannot read .gone.glb.: No such file or directory.*'
printf 'animation {\n  scene "ball.nff"\n  frames 2\n  object "t.stl" {\n    key 1 { translate <0, 0, 0> }\n    key 2 { translate <1, 0, 0> }\n  }\n}\n' >moved.anim
run pprt-render moved.anim --clock work -s 16x16 -o moved/%d.png; expect_code 0; [[ $(wc -l <err) -eq 1 ]] || complain "'$command': $(cat err)"

# What is damaged is refused as by pprt-convert.
echo nonsense >bad.glb
run pprt-render bad.glb -o bad.png; expect_code 3; expect_line err 'bad.glb: error: it begins neither as text in glTF nor as binary glTF'
run pprt-render bad.glb -np 2 -o bad.png; expect_code 3; expect_no_file bad.png
run pprt-render mesh/ball.glb -np 2 --clock work -s 32x32 -o two.png; expect_code 0
run pprt-render mesh/ball.glb --animation run -o none.png; expect_code 3
expect_line err "mesh/ball.glb: error: it has no animation 'run'"
finish

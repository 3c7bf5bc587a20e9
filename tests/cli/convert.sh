#!/usr/bin/env bash
# pprt-convert: formats, what is added and told, errors.
source "$(dirname "$0")/check.sh"

# There and back: the digits are the same.
run pprt-convert spd:tree:3 a.nff; expect_code 0; expect_text out ''; expect_text err ''
run pprt-convert a.nff b.nff; expect_code 0; expect_same a.nff b.nff
run pprt-convert - - <a.nff; expect_code 0; expect_same a.nff out

# Triangles: 15 spheres of 12 N^2 and 15 cones of 8 N.
run pprt-convert --tessellate 2 a.nff t.nff; expect_code 0
[[ $(grep -c '^pp 3$' t.nff) -eq $((15 * (48 + 16))) ]] || complain "--tessellate 2: $(grep -c '^pp' t.nff) patches"
[[ $(grep -c '^[sc] ' t.nff) -eq 0 ]] || complain "--tessellate 2: curved surfaces are left"
run pprt-convert --chord-error 0.001 a.nff fine.nff; expect_code 0
run pprt-convert --chord-error 0.1 a.nff coarse.nff; expect_code 0
[[ $(wc -l <fine.nff) -gt $(wc -l <coarse.nff) ]] || complain "--chord-error: the smaller error is not finer"

# Meshes, with the files that belong to them.
for extension in obj ply stl glb gltf dae; do
  run pprt-convert ball.nff "mesh/ball.$extension"; expect_code 0; expect_text err ''; expect_file "mesh/ball.$extension"
  run pprt-convert "mesh/ball.$extension" back.nff; expect_code 0
  [[ $(grep -c '^pp 3$' back.nff) -eq 432 ]] || complain "$command: $(grep -c '^pp' back.nff) patches came back"
done
expect_file mesh/ball.mtl; expect_file mesh/ball.bin

# What a mesh lacks is added, and told.
run pprt-convert mesh/ball.ply - ; expect_code 0
expect_text err "mesh/ball.ply: no camera: one that shows everything is added, with y up (--up z for the other)
mesh/ball.ply: no lights: a key light and a fill light are added"
expect_line out 'up 0 1 0'
run pprt-convert --up z mesh/ball.ply - ; expect_code 0; expect_line out 'up 0 0 1'
run pprt-convert mesh/ball.dae - ; expect_code 0; expect_text err ''
pprt-convert mesh/ball.ply ply.nff 2>/dev/null
run pprt-render ply.nff --clock work -s 16x16 -o ply.png; expect_code 0

# Scenes without a view cannot be POV-Ray's: one is added.
sed '/^[vfahru]/d' ball.nff >noview.nff
run pprt-convert noview.nff noview.pov; expect_code 0
expect_line err 'noview.nff: no camera: .*'; expect_line noview.pov 'camera {'
sed 's/^s .*/s 0 0 0 -1/' ball.nff >inside.nff
run pprt-convert inside.nff inside.pov; expect_code 0
expect_text err "inside.nff: 1 sphere or cone of which only the inside is seen: POV-Ray shows both sides"

# AFF: the scene at a time, and what is lost is told.
printf 'P3 2 1 255 255 0 0 0 255 102\n' >t.ppm
cat >moving.aff <<'SCENE'
v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8
am 1 1 1  l 0 0 20 .5 .25 1  a 1 3 5
fm .5 .5 .5 .5 .5 .5 0 0 0 0 0 0
m vertices 3 0 0 0 1 0 0 0 1 0 texturecoords 1 t.ppm 0 0 triangles 1 0 1 2 0 0 0
fm 0 0 0 .25 .5 0 .5 .25 .125 5 0 0
x ball { s 0 0 0 1 }
k ball { transl 4 0 0 0 0 0 0 0 1 1 0 0 0 0 0 3 3 0 0 0 0 0 4 4 0 0 0 0 0 }
SCENE
run pprt-convert moving.aff moving.pov; expect_code 0; expect_text err ''; expect_file moving-t.png

# No file that was read besides the one named is written to: a texture, what a mesh has in files of its own.
refuse() {
  expect_code 2
  expect_line err "pprt-convert: error: the input $1 and the output $2 are the same file; give each a name of its own"
}
mkdir read
cp t.ppm read
cp t.ppm read/two-t.png
{ cat moving.aff; grep '^m vertices' moving.aff | sed 's/t.ppm/two-t.png/'; } >read/both.aff
pprt-convert moving.aff read/tiles.obj 2>/dev/null
cp read/tiles.obj read/other.obj
ln ball.nff linked.nff
cp -r read kept
for format in aff pov obj; do
  run pprt-convert read/both.aff read/two.$format; refuse read/two-t.png read/two-t.png
  expect_no_file read/two.$format
done
run pprt-convert read/other.obj read/tiles.obj; refuse read/tiles.mtl read/tiles.mtl
run pprt-convert - linked.nff <linked.nff; refuse /dev/stdin linked.nff
[[ $(diff -r read kept) == '' ]] || complain "a file that was read was written to: $(diff -r read kept)"

run pprt-convert --at 3 moving.aff moving.nff; expect_code 0; expect_line moving.nff 's 3 0 0 1'
expect_text err "moving.aff: 1 texture is not kept: its surfaces get its mean colour
moving.aff: 1 material with a coloured highlight and mirror: it becomes white
moving.aff: the ambient light and its colours are not kept: NFF has none
moving.aff: the lights are made 2.00 times as bright, as readers of NFF weaken them"
run pprt-convert moving.aff - ; expect_code 0; expect_line out 's 1 0 0 1'
run pprt-convert moving.aff moving.obj; expect_code 0
expect_text err "moving.aff: the ambient light is not kept"
run pprt-convert moving.aff moving.stl; expect_code 0
expect_text err "moving.aff: 1 texture is not kept: its surfaces get its mean colour
moving.aff: the ambient light is not kept"
run pprt-convert --at 3 ball.nff x.nff; expect_code 2; expect_no_file x.nff
expect_text err "pprt-convert: error: --at: nothing moves in ball.nff"$'\n'"try 'pprt-convert --help'"
run pprt-convert --at soon moving.aff x.nff; expect_code 2; expect_no_file x.nff

# Errors: usage, scenes, failures.
run pprt-convert ball.nff ball.png; expect_code 2
expect_line err "pprt-convert: error: cannot tell the format of output 'ball.png': it must be FILE.nff, - (NFF on standard output) or FILE with one of .aff .pov .obj .ply .stl .glb .gltf .dae"
run pprt-convert ball.png ball.nff; expect_code 2
expect_line err "pprt-convert: error: cannot tell the format of input 'ball.png': .*"
run pprt-convert --tessellate 0 ball.nff x.nff; expect_code 2; expect_no_file x.nff
run pprt-convert --chord-error 0 ball.nff x.nff; expect_code 2
run pprt-convert --chord-error 0.1 --tessellate 3 ball.nff x.nff; expect_code 2
run pprt-convert --up x ball.nff x.nff; expect_code 2
run pprt-convert none.obj x.nff; expect_code 3; expect_text err "cannot read 'none.obj': No such file or directory"
echo nonsense >bad.glb
run pprt-convert bad.glb x.nff; expect_code 3; expect_text err 'bad.glb: error: it begins neither as text in glTF nor as binary glTF'
# A mesh that crashes Assimp, one that waits for ever, one that takes more than it may.
{ echo '<COLLADA version="1.4.1"><library_visual_scenes><visual_scene id="s">'; printf '<node>%.0s' {1..300000}; printf '</node>%.0s' {1..300000}
  echo '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>'; } >deep.dae
run pprt-convert deep.dae x.nff; expect_code 3; expect_no_file x.nff
expect_line err 'deep.dae: error: it is damaged, or has something that cannot be read: reading it ended in .*'
mkfifo pipe.obj
run pprt-convert pipe.obj x.nff; expect_code 3; expect_text err "cannot read 'pipe.obj': it is not a regular file"
run pprt-convert --mesh-seconds 0 mesh/ball.ply x.nff; expect_code 2; expect_no_file x.nff
run pprt-convert --memory many mesh/ball.ply x.nff; expect_code 2; expect_no_file x.nff
run pprt-convert --mesh-seconds 300 --memory 2G mesh/ball.ply x.nff; expect_code 0; rm x.nff
run pprt-convert --tessellate 1000 spd:balls:3 x.nff; expect_code 3; expect_line err '.* triangles, more than 20000000: cut them less finely'
expect_no_file x.nff
mkdir folder.ply
run pprt-convert ball.nff folder.ply; expect_code 1; expect_text err "pprt-convert: error: cannot write 'folder.ply': it is a directory"
run pprt-convert teapot:3 x.nff; expect_code 2
expect_text err "pprt-convert: error: cannot tell the format of input 'teapot:3': it must be FILE.nff, FILE.aff, - (NFF on standard input), spd:NAME[:SIZE] or a mesh such as FILE.obj; did you mean 'spd:teapot:3'?
try 'pprt-convert --help'"
finish

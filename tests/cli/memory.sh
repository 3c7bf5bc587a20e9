#!/usr/bin/env bash
# What reading may take is bounded, and told with the place that exceeds it.
source "$(dirname "$0")/check.sh"
head=$'v from 0 -5 2 at 0 0 0 up 0 0 1 angle 45 hither 0.1 resolution 16 16\nb .1 .2 .4\nf .8 .3 .2 .8 .1 10 0 1\n'
most='the most that reading may take (--memory)'

# A texture: 1024 x 1024 pixels of one colour make a small file.
{ printf 'P6 1024 1024 255\n'; head -c 3145728 /dev/zero; } >large.ppm
printf '%ss 0 0 0 1\n  tt large.ppm 0 0 2 0 0 1 0 2 1 0 0 1 2 0 1\n' "$head" >textured.aff
decoding='decoding 1024x1024 pixels takes 20.97 MB of memory, and'
for program in 'pprt-render textured.aff --samples 100 -o t.png' 'pprt-convert textured.aff t.nff'; do
  run $program --memory 10M; expect_code 3
  grep -q "^textured.aff:5:3: error: cannot read '.*large.ppm': $decoding 10 MB are left" err || complain "$(cat err)"
done
run pprt-render textured.aff --samples 100 -o t.png --memory 1G; expect_code 0

# Files that include each other: a few bytes make very many balls.
printf '%si 0 a.aff\n' "$head" >nested.aff
for pair in a:b b:c c:d; do
  for _ in {1..40}; do echo "i 0 ${pair#*:}.aff"; done >"${pair%:*}.aff"
done
for n in {1..40}; do echo "s $n 0 0 1"; done >d.aff
run pprt-render nested.aff --samples 100 -o n.png --memory 20M; expect_code 3
grep -q "^d.aff:[0-9]*:1: error: the scene takes more than 20 MB of memory, $most" err || complain "$(head -c 500 err)"

# NFF, and what a script adds to a scene.
{ printf '%s' $'v\nfrom 0 -5 2\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.1\nresolution 16 16\nl 3 -4 6\nf .8 .3 .2 .8 .1 10 0 1\n'
  for n in {1..3000}; do echo "s $n 0 0 1"; done; } >balls.nff
run pprt-render balls.nff --samples 100 -o b.png --memory 200k; expect_code 3
grep -q "^balls.nff:[0-9]*:1: error: the scene takes more than 0.2 MB of memory, $most" err || complain "$(head -c 500 err)"
run pprt-render balls.nff --samples 100 -o b.png --memory 500k; expect_code 0
echo 'animation { scene "balls.nff" frames 2 object "balls.nff" { key 1 { translate <0,0,9> } } }' >two.anim
run pprt-render two.anim --samples 100 -o s%d.png --memory 500k; expect_code 3
grep -q "^two.anim:1:48: error: .*takes more than" err || complain "$(head -c 500 err)"

run pprt-render balls.nff --memory 5X
expect_usage '--memory: value 5X is no size of memory, such as 500M or 4G'
run pprt-render balls.nff --memory 1500k --write-config; expect_code 0
grep -q '^memory *= *1500000' out || complain "$(grep memory out)"

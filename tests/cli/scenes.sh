#!/usr/bin/env bash
# Scenes and scripts: where they come from, and how they are refused.
source "$(dirname "$0")/check.sh"

run pprt-render none.nff; expect_code 3; expect_text out ''
expect_text err "cannot read 'none.nff': No such file or directory"
run pprt-render ball.nff none.anim; expect_code 3
expect_text err "cannot read 'none.anim': No such file or directory"
# What was probably meant.
run pprt-render bal.nff; expect_code 3; expect_text err "cannot read 'bal.nff': No such file or directory; did you mean 'ball.nff'?"
run pprt-render ./bal.anim; expect_code 3; expect_text err "cannot read './bal.anim': No such file or directory; did you mean './ball.anim'?"
for name in teapot spd-teapot sdp:teapot; do
  run pprt-render $name:5; expect_code 3
  expect_text err "cannot read '$name:5': No such file or directory; did you mean 'spd:teapot:5'?"
done
run pprt-render spd:teapt; expect_code 3
expect_text err "spd:teapt: error: no procedural database has the name 'teapt'; did you mean 'teapot'? (there are: tree balls gears mount rings tetra teapot jacks lattice)"
run pprt-render spd:bush; expect_code 3
expect_text err "spd:bush: error: no procedural database has the name 'bush' (there are: tree balls gears mount rings tetra teapot jacks lattice)"

# Every problem, each with its place.
sed 's/^s .*/s 0 0 zero 1/; s/^l .*/l 5 five 5/' ball.nff >bad.nff
bad_scene="bad.nff:9:5: error: expected a number for y of the position of 'l', found 'five'
    l 5 five 5
        ^
bad.nff:11:7: error: expected a number for z of the centre of 's', found 'zero'
    s 0 0 zero 1
          ^"
run pprt-render bad.nff; expect_code 3; expect_text err "$bad_scene"; expect_text out ''
run pprt-render -np 3 bad.nff; expect_code 3; expect_text err "$bad_scene"; expect_text out ''

sed '/^[vahru]/d; /^from/d' ball.nff >noview.nff
run pprt-render noview.nff; expect_code 3
noview="noview.nff: error: the scene has no view ('v' ...) and no script gives a camera; 'pprt-convert noview.nff OUT.nff' adds a view of the whole scene"
expect_text err "$noview"
# The warnings first, as one of them may tell why.
echo 'V from 0 0 5' >>noview.nff
run pprt-render noview.nff; expect_code 3
expect_text err "noview.nff:5:1: warning: unknown entity 'V': skipped to the end of its line
    V from 0 0 5
    ^
$noview"
run pprt-convert noview.nff added.nff; expect_code 0
expect_line err 'noview.nff: no camera: one that shows everything is added, with y up (--up z for the other)'
run pprt-render added.nff --clock work -s 16x16 -o added.png; expect_code 0; expect_file added.png

# Nothing to see: said before anything is written.
sed 's/^at .*/at 0 0 9/' ball.nff >behind.nff
for np in 1 2; do
  run pprt-render -np $np behind.nff -o blank.png --stats blank.ndjson; expect_code 3
  expect_text err "behind.nff: error: nothing is to be seen: all objects lie behind the eye"
  expect_no_file blank.png; expect_no_file blank.ndjson; expect_no_file manifest.ndjson
done
sed '/^[lbf] /d' ball.nff >dark.nff
run pprt-render dark.nff --clock work -o dark.png; expect_code 0; expect_file dark.png
expect_line err 'dark.nff: warning: the scene has no light: its objects show in ambient light alone'

sed 's/at <0, 0, 0>/at <0, 0, 5>/; s/angle 45/angle 190/' ball.anim >bad.anim
run pprt-render bad.anim; expect_code 3; expect_line err 'bad.anim:[0-9]*:[0-9]*: error: .*'; expect_line err ' *^'
grep -v scene ball.anim >noscene.anim
run pprt-render noscene.anim
expect_usage "the script noscene.anim names no scene: give one before it, or add 'scene \"...\"' to it"

# An eye from which doubles cannot resolve the scene: in a still, and in the middle of a path, before its first frame.
sed 's/^from .*/from 0 0 1e20/' ball.nff >far.nff
run pprt-render far.nff -o far.png; expect_code 3
expect_text err "far.nff: error: the eye is 5.0e+19 times the scene's size away; the most is 1.1e+12"
sed 's/key 12 .*/key 8 { from <0, 0, 1e20> } key 12 { from <5, 0, 0> }/' ball.anim >far.anim
run pprt-render far.anim -o far_%02d.png; expect_code 3
expect_line err "far.anim: error: frame [2-8]: the eye is [0-9.e+]* times the scene's size away; the most is 1.1e+12"
expect_no_file far_01.png

# A scene that the script names and that is not there: the place in the script.
sed 's/ball.nff/ballx.nff/' ball.anim >missing.anim
run pprt-render missing.anim; expect_code 3
expect_text err "missing.anim:2:3: error: cannot read 'ballx.nff': No such file or directory; did you mean 'ball.nff'?
      scene \"ballx.nff\"
      ^"
sed 's/ball.nff/spd:tre:3/' ball.anim >missing.anim
run pprt-render missing.anim; expect_code 3
expect_line err "missing.anim:2:3: error: spd:tre:3: no procedural database has the name 'tre'; did you mean 'tree'? .*"
sed 's/ball.nff/bad.nff/' ball.anim >missing.anim  # it is there: its own problems
run pprt-render missing.anim; expect_code 3; expect_text err "$bad_scene"
# No control character of a script reaches the terminal.
for name in $'a\e[31mb.nff' $'spd:\e[31mb' $'a\xc2\x9b31mb.nff'; do
  printf 'animation {\n  scene "%s" frames 2\n}\n' "$name" >hostile.anim
  run pprt-render hostile.anim; expect_code 3; expect_line err 'hostile.anim:2:3: error: .*\(\\x1b\[\|\\xc2\\x9b\)31mb.*'
  if LC_ALL=C grep -q $'[\x01-\x08\x0b-\x1f\x7f]\|\xc2[\x80-\x9f]' err; then complain "'$command': control characters: $(cat -v err)"; fi
done

# Faces that coincide: the still settles with as many samples as one whose second face lies below, and shows the same.
# The other way round it is another picture.
faces() {
  printf 'v\nfrom 0 3 4\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 64\nl 3 6 4\n'
  for face in "$@"; do
    case $face in
      first) printf 'f 1 0 0 1 0 1 0 1\np 4\n-1 0 -1\n-1 0 1\n1 0 1\n1 0 -1\n' ;;
      second) printf 'f 0 0 1 1 0 1 0 1\np 4\n-.7 %s -.5\n-.7 %s .6\n.9 %s .6\n.9 %s -.5\n' "$height" "$height" "$height" "$height" ;;
    esac
  done
}
height=0 faces first second >coincident.nff
height=-.3 faces first second >below.nff
height=0 faces second first >other.nff
for name in coincident below other; do
  run pprt-render $name.nff --clock work -o $name.png --stats $name.stats; expect_code 0
done
samples() { grep -o '"samples_new":[0-9]*' "$1.stats" | head -1 | tail -c +15; }
(($(samples coincident) * 2 < $(samples below) * 3)) || complain "coincident faces take $(samples coincident) samples, others $(samples below)"
run pprt-compare coincident.png below.png --max-rmse 0.01; expect_code 0
run pprt-compare coincident.png other.png --max-rmse 0.03; expect_code 1

# Standard input is as good as a file.
run pprt-render ball.nff --clock work -o a.png; expect_code 0
pprt-render - --clock work -o b.png <ball.nff 2>err; expect_same a.png b.png
finish

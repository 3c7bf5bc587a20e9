#!/usr/bin/env bash
# No output takes the place of another one, of an input, or of a file that is there already.
source "$(dirname "$0")/check.sh"
work=(--clock work --budget 400000)
still=(ball.nff --samples 50)
there='is there already; --overwrite replaces it, --resume goes on after it'

# refuse MESSAGE OPTIONS...: nothing is written, whether or not files may be replaced.
refuse() {
  local message=$1 flag
  shift
  for flag in --progress=none --overwrite --resume; do
    run pprt-render "$@" $flag
    expect_usage "$message; give each a name of its own"
  done
}
same() { echo "$1 and $2 are the same file"; }

# Two outputs of one name.
refuse "$(same '--contact-sheet a.png' 'the frame a.png')" "${still[@]}" -o a.png --contact-sheet a.png
refuse "$(same 'the frame a.png' 'the frame a.png')" "${still[@]}" -o a.png -o a.png
refuse "$(same '--stats ./a.png' 'the frame a.png')" "${still[@]}" -o a.png --stats ./a.png
refuse "$(same '--film f.mp4' "--stats $PWD/f.mp4")" "${still[@]}" -o a.png --film f.mp4 --stats "$PWD/f.mp4"
refuse "$(same 'the manifest manifest.ndjson' '--stats new/../manifest.ndjson')" \
  ball.anim "${work[@]}" -o %04d.png --stats new/../manifest.ndjson
refuse "$(same 'the frame a.depth.png' 'the frame a.depth.png')" "${still[@]}" --layers depth -o a.png -o a.depth.png
refuse "$(same 'the frame a11.png' 'the frame a11.png')" ball.anim "${work[@]}" -o a1%d.png -o a%d.png
mkdir real
ln -s real link
refuse "$(same 'the frame real/1.png' 'the frame link/1.png')" ball.anim "${work[@]}" -o real/%d.png -o link/%d.png
ln -s later.png dangling
refuse "$(same '--stats dangling' 'the frame later.png')" "${still[@]}" -o later.png --stats dangling
[[ $(ls -A real; find . -name '*.png') == '' ]] || complain "something was written: $(ls -A . real)"
rm dangling

# An output in place of an input, by whatever name.
cp ball.nff kept.nff
cp ball.anim kept.anim
ln ball.nff hard
ln -s ball.nff soft
for name in ball.nff ./ball.nff hard soft "$PWD/soft"; do
  refuse "$(same 'the scene ball.nff' "--stats $name")" "${still[@]}" -o a.png --stats "$name"
done
refuse "$(same 'the script ball.anim' '--stats ball.anim')" ball.anim "${work[@]}" -o %d.png --stats ball.anim
refuse "$(same 'the scene ball.nff' '--stats hard')" ball.anim "${work[@]}" -o %d.png --stats hard
echo 'seed=3' >run.ini
refuse "$(same '--config run.ini' '--stats run.ini')" "${still[@]}" --config run.ini -o a.png --stats run.ini
refuse "$(same '--hostfile run.ini' '--stats run.ini')" "${still[@]}" --hostfile run.ini -o a.png --stats run.ini
run pprt-render - --samples 50 -o a.png --stats ball.nff --overwrite <ball.nff
expect_usage "$(same 'the scene /dev/stdin' '--stats ball.nff'); give each a name of its own"
expect_same ball.nff kept.nff; expect_same ball.anim kept.anim
run pprt-render "${still[@]}" -o ref.png; expect_code 0
ln ref.png ref2.png
for name in ref.png ref2.png; do
  refuse "$(same '--reference ref.png' "the frame $name")" "${still[@]}" -o $name --reference ref.png
done
# What was read besides: a texture, what a scene includes, what a script moves, and with what these show.
cat >toy.aff <<'AFF'
v from 0 3 9 at 0 1 0 up 0 1 0 angle 40 hither 1 resolution 16 12
am 1 1 1 b .2 .3 .4 l 4 8 6 .7 .7 .7 a 1 2 6
fm .2 .2 .2 .7 .7 .7 0 0 0 0 0 1
tt wood.png -6 0 6 0 1 6 0 6 1 1 0 0 -6 0.5 0
i 0 sub.aff
AFF
echo 's 0 .7 0 .7' >sub.aff
cp ref.png wood.png
ln wood.png hard.png
ln -s sub.aff soft.aff
printf 'animation { scene "ball.nff" frames 2 object "toy.aff" { key 1 { translate <0, 0, 0> } } }' >toy.anim
mkdir before
cp toy.aff sub.aff wood.png toy.anim before
for input in "toy.aff --samples 50 --frames 1" "toy.anim --samples 50 --frames 1"; do
  for name in wood.png "$PWD/wood.png" hard.png; do
    refuse "$(same 'the input wood.png' "the frame $name")" $input -o $name
    refuse "$(same 'the input wood.png' "--contact-sheet $name")" $input -o a.png --contact-sheet $name
  done
  for name in sub.aff soft.aff; do
    refuse "$(same 'the input sub.aff' "--stats $name")" $input -o a.png --stats $name
    refuse "$(same 'the input sub.aff' "--balance-trace $name")" $input -o a.png --balance-trace $name
  done
done
refuse "$(same 'the input toy.aff' '--stats toy.aff')" toy.anim --samples 50 --frames 1 -o a.png --stats toy.aff
for file in toy.aff sub.aff wood.png toy.anim; do expect_same $file before/$file; done

# Ranks under mpirun say the same, once.
run pprt-render "${still[@]}" -np 2 -o a.png --stats hard --overwrite
expect_usage "$(same 'the scene ball.nff' '--stats hard'); give each a name of its own"

# The ledger is an output like frames.
cp kept.nff precious
run pprt-render "${still[@]}" -o b.png --stats precious; expect_usage "precious $there"
ln -s precious to_precious
run pprt-render "${still[@]}" -o b.png --stats to_precious; expect_usage "to_precious $there"
ln -s nothing to_nothing
run pprt-render "${still[@]}" -o b.png --stats to_nothing; expect_usage "to_nothing $there"
run pprt-render "${still[@]}" -o b.png --stats to_precious --overwrite; expect_code 0
expect_same precious kept.nff
[[ $(wc -l <to_precious) -eq 3 && ! -L to_precious ]] || complain "the ledger is not a new file: $(cat to_precious)"
# The same command twice.
for ((i = 0; i < 2; ++i)); do
  run pprt-render "${still[@]}" "${work[@]:0:2}" -o c.png --stats c.ndjson --contact-sheet s.png --overwrite; expect_code 0
done
[[ $(wc -l <c.ndjson) -eq 3 ]] || complain "the ledger was not replaced: $(cat c.ndjson)"
run pprt-render "${still[@]}" "${work[@]:0:2}" -o c.png --stats c.ndjson --contact-sheet s.png --resume; expect_code 0
[[ $(wc -l <c.ndjson) -eq 5 ]] || complain "the ledger was not extended: $(cat c.ndjson)"
# What a killed run has left of a line stays a line of its own.
printf '{"record":"fra' >>c.ndjson
run pprt-render "${still[@]}" "${work[@]:0:2}" -o c.png --stats c.ndjson --resume; expect_code 0
[[ $(grep -c '^{"record":"run"' c.ndjson) -eq 3 ]] || complain "a record was glued to half of one: $(cat c.ndjson)"

# Only a ledger goes on as one, and only a trace as a trace. A run that is refused has written to neither.
run pprt-render "${still[@]}" "${work[@]:0:2}" -o c.png --balance-trace c.trace --resume; expect_code 0
printf 'my notes' >notes
cp notes kept_notes; cp c.ndjson kept.ndjson; cp c.trace kept.trace
for name in notes c.trace c_manifest.ndjson; do
  [[ $name == c_manifest.ndjson ]] && other=d.png || other=c.png
  run pprt-render "${still[@]}" "${work[@]:0:2}" -o $other --stats $name --resume
  expect_usage "--resume: $name is there already and is no ledger; --overwrite replaces it"
done
for name in notes c.ndjson; do
  run pprt-render "${still[@]}" "${work[@]:0:2}" -o c.png --balance-trace $name --resume
  expect_usage "--resume: $name is there already and is no balancing trace; --overwrite replaces it"
done
run pprt-render "${still[@]}" "${work[@]:0:2}" --seed 9 -o c.png --stats c.ndjson --balance-trace c.trace --resume
expect_usage "--resume: c_manifest.ndjson is of another scene or other options; --overwrite starts anew"
expect_same notes kept_notes; expect_same c.ndjson kept.ndjson; expect_same c.trace kept.trace

# Frames that a tool has made hard links of are frames of their own.
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o d/%d.png; expect_code 0
ln -f d/1.png d/2.png
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o d/%d.png --overwrite; expect_code 0
if cmp -s d/1.png d/2.png; then complain "the frames are one file"; fi

# Pipes and devices are not replaced, and need no leave.
for device in /dev/null /dev/stdout; do
  run pprt-render "${still[@]}" -o e.png --stats $device; expect_code 0
  rm e.png
done
[[ $(wc -l <out) -eq 3 ]] || complain "no ledger on /dev/stdout: $(cat out)"
mkfifo pipe
cat pipe >from_pipe &
run pprt-render "${still[@]}" -o e.png --stats pipe; expect_code 0
wait
[[ $(wc -l <from_pipe) -eq 3 && -p pipe ]] || complain "no ledger from the pipe: $(cat from_pipe)"

# What cannot be written is told before the first frame, in words.
touch file
run pprt-render "${still[@]}" -o g.png --stats file/led; expect_code 1
expect_text err "pprt-render: error: cannot write 'file/led': Not a directory"
run pprt-render "${still[@]}" -o g.png --stats real; expect_code 1
expect_text err "pprt-render: error: cannot write 'real': Is a directory"
long=$(printf 'n%.0s' {1..300})
run pprt-render "${still[@]}" -o $long.png; expect_code 1
expect_text err "pprt-render: error: cannot write '$long.png': File name too long"
run pprt-render "${still[@]}" -o g.png --stats $long; expect_code 1
expect_text err "pprt-render: error: cannot write '$long': File name too long"
run pprt-render "${still[@]}" -o g.png --film file/x.mp4; expect_code 1
expect_text err "pprt-render: error: cannot write 'file/x.mp4': Not a directory"
run pprt-render "${still[@]}" -o g.png --reference $long.png
expect_usage "--reference: cannot read '$long.png': File name too long"
mkdir sheet.png
run pprt-render "${still[@]}" -o g.png --contact-sheet sheet.png --overwrite; expect_code 1
expect_text err "pprt-render: error: cannot write 'sheet.png': it is a directory"
expect_no_file g.png

# Names in Latin-1: the scene's, the frames', the ledger's.
latin=$'K\xe4se'
cp ball.nff "$latin.nff"
run pprt-render "$latin.nff" --samples 50 -o "$latin/%02d.png" --stats "$latin.ndjson"; expect_code 0
expect_file "$latin/01.png"
expect_line "$latin.ndjson" '{"record":"run",.*"scene":{"latin-1":"Käse.nff"},.*}'
expect_line "$latin/manifest.ndjson" '{"record":"frame","frame":1,"files":\[{"latin-1":"Käse/01.png"}\],"crc32":\["[0-9a-f]\{8\}"\],"key":"[0-9a-f]\{16\}"}'
for np in 1 2; do
  more=("$latin.anim" "${work[@]}" -np $np --frames 1-2 -o "$latin$np/%02d.png")
  sed "s/ball.nff/$latin.nff/" ball.anim >"$latin.anim"
  run pprt-render "${more[@]}" --progress json; expect_code 0
  run pprt-render "${more[@]}" --resume; expect_code 0
  expect_text err "done: 0 of 2 frames (2 were there already) in $latin$np/01.png to $latin$np/02.png"
done
finish

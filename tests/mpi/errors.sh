#!/usr/bin/env bash
# An error in the input is reported once, by one rank, and every rank exits with its code.
source "$(dirname "$0")/lib.sh"

printf 'v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 8 8\ns 0 0\n' >broken.nff
for way in own hand; do
  code=0
  if [[ $way == own ]]; then
    pprt-render broken.nff -np 4 -o broken.png 2>told || code=$?
  else
    mpirun_by_hand -np 4 pprt-render broken.nff -o broken.png 2>told || code=$?
  fi
  [[ $code == 3 ]] || { cat told >&2; fail "a broken scene ended with code $code instead of 3 ($way)"; }
  [[ $(grep -c 'broken.nff:[0-9]*:[0-9]*: error' told) == 1 ]] ||
    { cat told >&2; fail "one report of the error was wanted ($way)"; }
  [[ ! -e broken.png ]] || fail "a picture was written"
done
# Every rank finds the wrong option; only one reports it.
code=0
mpirun_by_hand -np 3 pprt-render broken.nff --bogus 2>told || code=$?
[[ $code == 2 && $(grep -c -- --bogus told) == 1 ]] || { cat told >&2; fail "a usage error ended with code $code"; }
for what in --help --write-config; do
  mpirun_by_hand -np 3 pprt-render broken.nff $what >told || fail "$what failed"
  [[ $(grep -cE 'Usage: |max-depth' told) == 1 ]] || { cat told >&2; fail "$what was not told once"; }
done
code=0
pprt-render no-such.nff -np 4 -o none.png 2>told || code=$?
[[ $code == 3 ]] || fail "a missing scene ended with code $code instead of 3"

# Nothing that mpirun understands can be said through pprt-render: ":" would start another program.
for words in ": touch made" "ball.nff : -np 1 touch made" "--mca orte_launch_agent touch"; do
  code=0
  # shellcheck disable=SC2086
  pprt-render -np 2 -o x.png $words >/dev/null 2>told || code=$?
  [[ $code == 2 || $code == 3 ]] || { cat told >&2; fail "'$words' ended with code $code"; }
  [[ ! -e made ]] || fail "'$words' started another program"
done

# An error of rank 0 in mid-run, also with --go-on.
cat >long.anim <<'END'
animation { frames 400 fps 20 resolution <32, 24> camera { key 1 { from <4, 0, 2> at <0, 0, 1> up <0, 0, 1> } key 400 { from <2, 3, 2> } } }
END
for go_on in '' --go-on; do
  code=0
  # shellcheck disable=SC2086 # no word, where the run does not go on
  pprt-render spd:tree:3 long.anim -np 2 $go_on --progress none -o out/%04d.png 2>told &
  for ((i = 0; i < 1500; ++i)); do [[ -s out/manifest.ndjson ]] && break || sleep 0.02; done
  rm -r out
  : >out
  wait $! || code=$?
  [[ $code == 1 ]] || { cat told >&2; fail "frames that cannot be written end with code $code ($go_on)"; }
  grep -q "error: .*out" told || { cat told >&2; fail "the reason is not told ($go_on)"; }
  rm out
done

#!/usr/bin/env bash
# completion.sh: what the shells offer, asked of the shells themselves; zsh and fish where they are installed.
here=$(cd "$(dirname "$0")" && pwd)
source "$here/check.sh"
mkdir zsh
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  for shell in bash zsh fish; do
    run "$program" --completion $shell; expect_code 0; expect_text err ''
    cp out "$program.$shell"
  done
  cp "$program.zsh" "zsh/_$program"
done
run pprt-render --completion tcsh; expect_usage "--completion: 'tcsh' is none of bash, zsh, fish"

# Line, and what may stand at its end. Bash replaces what stands behind the last colon only.
cases() {
  cat <<'CASES'
pprt-render --cl|--clock
pprt-render ball.nff --clock |wall work
pprt-render --clock w|wall work
pprt-render --samples |
pprt-render --over|--overwrite
pprt-render ba|ball.anim ball.nff
pprt-render --overwrite bal|ball.anim ball.nff
pprt-render --hostfile ba|ball.anim ball.nff
pprt-render spd:te|spd:teapot spd:tetra
pprt-convert spd:te|spd:teapot spd:tetra
pprt-convert --up |y z
pprt-compare --max-fl|--max-flicker --max-flip
pprt-study |accuracy balance counts paper rate
pprt-study paper --mach|--machine
pprt-study paper --machine |cluster sp2
pprt-study counts spd:te|spd:teapot spd:tetra
CASES
}

expect_offer() {  # SHELL LINE WORDS OFFERED
  [[ $3 == "$4" ]] || complain "$1: at the end of '$2' stands '$4', not '$3'"
}
one_line() { sort | xargs; }

# As readline would, but for its taking words apart at colons.
in_bash() {
  bash -c 'compopt() { :; }; COMP_WORDBREAKS=$'"' \\t\\n'"'
           source "$1"; COMP_LINE=$2 COMP_POINT=${#2}; "_${3//-/_}"; printf "%s\n" "${COMPREPLY[@]}"' \
    - "${1%% *}.bash" "$1" "${1%% *}" | one_line
}
seen=0
while IFS='|' read -r line words; do
  expect_offer bash "$line" "$words" "$(in_bash "$line")"
  seen=$((seen + 1))
done < <(cases)
[[ $seen -eq 16 ]] || complain "only $seen lines were tried"
expect_offer bash 'of layers' 'samples,density samples,depth' "$(in_bash 'pprt-render --layers samples,d')"
expect_offer bash 'of methods' 'control,paper-weights' "$(in_bash 'pprt-study accuracy --methods control,pap')"
expect_offer bash 'behind an equals sign' 'wall work' "$(in_bash 'pprt-render --clock=w')"
colons=$(bash -c 'compopt() { :; }; source pprt-render.bash; COMP_LINE="pprt-render spd:te" COMP_POINT=18
                  _pprt_render; printf "%s\n" "${COMPREPLY[@]}"' | one_line)
expect_offer bash 'behind a colon' 'teapot tetra' "$colons"

if command -v fish >/dev/null; then
  while IFS='|' read -r line words; do
    # Where any word may stand, it offers files; and since version 4 words that only hold what was typed.
    [[ -n $words ]] || continue
    offered=$(HOME=$PWD fish --no-config -c "source ${line%% *}.fish; complete -C '$line'" | cut -f1 | grep -v '/$' |
      grep -e "^${line##* }" | one_line)
    expect_offer fish "$line" "$words" "$offered"
  done < <(cases | grep -v '^pprt-study |')
else
  echo 'fish is not installed: its completion is not tried'
fi

# What zsh shows has descriptions beside the words.
if command -v zsh >/dev/null; then
  for script in zsh/_*; do zsh -n "$script" || complain "zsh: $script"; done
  while IFS='|' read -r line words; do
    shown=$(HOME=$PWD timeout 60 zsh -f "$here/zsh_offers.zsh" "$PWD/zsh" "$line" | tr -s ' \n' '\n\n')
    for word in $words; do
      grep -qxF -e "$word" <<<"$shown" || complain "zsh: at the end of '$line' stands no '$word' but '$shown'"
    done
    if grep -qxF -e paper -e --resume -e ball.nff -e off <<<"$shown" && [[ ! $words =~ paper|ball.nff ]]; then
      complain "zsh: at the end of '$line' stands '$shown'"
    fi
  done < <(cases)
else
  echo 'zsh is not installed: its completion is not tried'
fi
finish

#!/usr/bin/env bash
# demo_can_fail.sh SOURCE_DIR: debian/tests/demo, which tests the installed package, passes with the programs on the PATH.
# It fails for its reason with programs that do something else. What it renders in the same words is rendered once.
set -euo pipefail
source=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PPRT=$PATH DEMO=$scratch/demo.anim
sed "s/fps 4 /fps 24 /" "$source/scenes/demo.anim" >"$DEMO"  # faster
mkdir "$scratch/programs" "$scratch/once" "$scratch/kept"
export KEPT=$scratch/kept
cat >"$scratch/once/pprt-render" <<'END'
#!/bin/bash
# Runs the program in a folder of its own, once for the same words, and gives what it has left there.
set -euo pipefail
words=$(printf '%s\n' "$@" | sha256sum)
kept=$KEPT/${words%% *}
if [[ ! -d $kept ]]; then
  mkdir "$kept"
  (cd "$kept" && PATH=$PPRT pprt-render "$@")
fi
cp -r "$kept/." .
END
chmod +x "$scratch/once/pprt-render"
export ONCE=$scratch/once:$PATH

# run: the test with the programs of $scratch/programs before those on the PATH; its last line in $said.
run() {
  rm -rf "$scratch/work"
  mkdir "$scratch/work"
  code=0
  said=$(AUTOPKGTEST_TMP=$scratch/work PATH=$scratch/programs:$ONCE "$source/debian/tests/demo" 2>&1) || code=$?
  said=${said##*$'\n'}
}
# expect_failure TEXT PROGRAM: reads a shell script that stands for the program; with it, the test fails with the text.
expect_failure() {
  { echo '#!/bin/bash'; echo 'PATH=$ONCE'; cat; } >"$scratch/programs/$2"
  chmod +x "$scratch/programs/$2"
  run
  rm "$scratch/programs/$2"
  [[ $code -eq 1 && $said == "demo: $1" ]] || { echo "instead of '$1': code $code, '$said'"; exit 1; }
}

run
[[ $code -eq 0 && $said == 'demo: 33 frames are as they should be' ]] || { echo "code $code: $said"; exit 1; }
expect_failure 'real_time/0007.png is no picture' pprt-render <<'END'
pprt-render "$@" && rm real_time/0007.png
END
expect_failure 'these were not three ranks' pprt-render <<'END'
pprt-render "${@/#3/2}"
END
expect_failure 'once/%04d.png is not as again/%04d.png' pprt-render <<'END'
[[ $* != *again* ]] || set -- "$@" --sampler grid
pprt-render "$@"
END
expect_failure 'once/%04d.png is not as fine/%04d.png' pprt-render <<'END'
pprt-render "$@"
[[ $* != *fine* ]] || cp fine/0001.png fine/0003.png
END
expect_failure 'pprt-compare gives 0 for different frames' pprt-compare <<'END'
exit 0
END

# What the scripts here share. Each runs in a scratch directory of its own, with the programs on the PATH, and checks
# exit codes and whole messages. Pictures are tiny and the work clock counts, so that no load can change a result.
set -euo pipefail

scratch=$(mktemp -d)
# Not by a process of this shell that is killed before it has become another program.
trap '[[ $BASHPID != $$ ]] || rm -rf "$scratch"' EXIT
cd "$scratch"
failures=0

complain() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# run COMMAND...: its exit code in $code, what it printed in the files out and err.
run() {
  code=0
  command="$*"
  "$@" >out 2>err || code=$?
}

# expect_code N: how the last command ended.
expect_code() {
  [[ $code -eq $1 ]] || complain "'$command' ended with $code, not $1; it said: $(cat err)"
}

# expect_text FILE TEXT: the file holds exactly this text.
expect_text() {
  local difference
  difference=$(diff <(printf '%s' "${2:+$2$'\n'}") "$1") || complain "'$command': $1 (>) is not as expected (<):"$'\n'"$difference"
}

# expect_line FILE PATTERN: some line of the file matches the whole pattern, as grep -x has it.
expect_line() { grep -qx -- "$2" "$1" || complain "'$command': no line '$2' in $1: $(cat "$1")"; }

expect_file() { [[ -f $1 ]] || complain "'$command': there is no file $1"; }
expect_no_file() { [[ ! -e $1 ]] || complain "'$command': there is a file $1"; }
expect_same() { cmp -s "$1" "$2" || complain "'$command': $1 and $2 differ"; }

# expect_usage TEXT: refused with exit code 2, this message, the hint at --help, and nothing on standard output.
expect_usage() {
  expect_code 2
  expect_text err "pprt-render: error: $1"$'\n'"try 'pprt-render --help'"
  expect_text out ''
}

finish() {
  [[ $failures -eq 0 ]] || { echo "$failures checks failed"; exit 1; }
}

# A mirroring ball in 16x16 pixels.
cat >ball.nff <<'SCENE'
v
from 0 0 5
at 0 0 0
up 0 1 0
angle 45
hither 1
resolution 16 16
b 0 0 1
l 5 5 5
f 1 1 1 0.5 0.5 10 0 1
s 0 0 0 1
SCENE

# Twelve frames round it.
cat >ball.anim <<'SCRIPT'
animation {
  scene "ball.nff"
  frames 12  fps 4  resolution <32, 24>
  camera {
    key 1  { from <0, 0, 5> at <0, 0, 0> up <0, 1, 0> angle 45 }
    key 12 { from <5, 0, 0> }
  }
}
SCRIPT

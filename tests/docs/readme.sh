#!/usr/bin/env bash
# readme.sh README SOURCE_DIR LEAST: runs the README's blocks marked "```sh runnable" in a scratch directory, one after
# the other, with the programs built on the PATH; every command must succeed. There must be LEAST commands of pprt.
# A block marked "```sh live" is one command that runs until Ctrl-C: it gets that once it has printed its address.
# Blocks marked "```sh building" are run by tests/package/builds.sh, and there are no others.
set -euo pipefail
readme=$1 source=$2 least=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/scenes" "$source/examples" "$scratch"
cd "$scratch/$(realpath --relative-to="$source" "$(dirname "$readme")")"
export XDG_CACHE_HOME=$scratch/cache
# For who runs mpirun as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
if others=$(grep -n '^```.' "$readme" | grep -v -e ':```sh runnable$' -e ':```sh live$' -e ':```sh building$'); then
  echo "commands that no test runs: $others"
  exit 1
fi
# until_address COMMAND...: on a port that is free, and ended as by Ctrl-C.
until_address() {
  local log=$scratch/live.log process
  set -m  # in a group of its own, as of a terminal
  "$@" 2>"$log" &
  process=$!
  set +m
  for _ in {1..300}; do
    ! grep -q 'http://' "$log" || break
    sleep 0.1
  done
  grep -q 'http://' "$log" || { cat "$log"; return 1; }
  kill -INT "$process"
  wait "$process" || { cat "$log"; return 1; }
}
awk '/^```/ { inside = ($0 == "```sh runnable"); live = ($0 == "```sh live"); next }
     inside { print }
     live { sub(/--live 8080/, "--live 0"); print "until_address " $0 }' "$readme" >"$scratch/commands.sh"
[[ $(grep -cE '^ *(until_address )?pprt-' "$scratch/commands.sh") -ge $least ]] || { echo "hardly a command to run in $readme"; exit 1; }
set -x
source "$scratch/commands.sh"

#!/usr/bin/env bash
# readme.sh README SOURCE_DIR: runs the README's blocks marked "```sh runnable" in a scratch directory, one after the
# other, with the programs built on the PATH; every command must succeed. Blocks marked "```sh building" are run by
# tests/package/builds.sh, and there are no others.
set -euo pipefail
readme=$1 source=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/scenes" "$scratch"
cd "$scratch"
export XDG_CACHE_HOME=$scratch/cache
# For who runs mpirun as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
if others=$(grep -n '^```.' "$readme" | grep -v -e ':```sh runnable$' -e ':```sh building$'); then
  echo "commands that no test runs: $others"
  exit 1
fi
awk '/^```/ { inside = ($0 == "```sh runnable"); next } inside' "$readme" >commands.sh
[[ $(grep -c '^pprt-' commands.sh) -ge 12 ]] || { echo "the README has hardly a command to run"; exit 1; }
bash -euxo pipefail commands.sh

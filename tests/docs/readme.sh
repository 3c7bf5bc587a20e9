#!/usr/bin/env bash
# readme.sh README SOURCE_DIR: runs the README's blocks marked "```sh runnable" in a scratch directory, one after the
# other, with the programs built on the PATH; every command must succeed.
set -euo pipefail
readme=$1 source=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/scenes" "$scratch"
cd "$scratch"
export XDG_CACHE_HOME=$scratch/cache
awk '/^```/ { inside = ($0 == "```sh runnable"); next } inside' "$readme" >commands.sh
[[ $(grep -c '^pprt-' commands.sh) -ge 4 ]] || { echo "the README has hardly a command to run"; exit 1; }
bash -euxo pipefail commands.sh

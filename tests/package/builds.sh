#!/usr/bin/env bash
# builds.sh SOURCE_DIR SUITE: on a bare Debian system the README's commands for building do what they say, with warnings
# as errors, and the unit tests pass; the package that they make installs, runs and goes on another such system.
set -euo pipefail
source=$1 suite=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
{
  echo 'set -euxo pipefail; sudo() { "$@"; }; export CXXFLAGS=-Werror'
  echo 'apt-get update -qq && apt-get install -qq -y --no-install-recommends dpkg-dev file >/dev/null'
  awk '/^```/ { inside = ($0 == "```sh building"); next } inside' "$source/README.md"
  echo 'ctest --preset release -L unit; test -s frames/0024.png; pprt-render --version'
} >building.sh
[[ $(grep -c 'cmake\|scripts/demo' building.sh) -ge 3 ]] || { echo 'the README hardly tells how to build'; exit 1; }
"$source/scripts/bare-debian" -a building.sh -f 'build/release/pprt_*.deb' "$suite" bash building.sh
"$source/scripts/bare-debian" -a "$(echo "$scratch"/pprt_*.deb)" "$suite" tests/package/in_bare_debian.sh

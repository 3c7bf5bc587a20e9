#!/usr/bin/env bash
# builds.sh SOURCE_DIR SUITE: on a bare Debian system the README's commands for building do what they say, with warnings
# as errors, and the unit tests pass. The package is built without them, as scripts/package runs them.
set -euo pipefail
source=$1 suite=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
{
  echo 'set -euxo pipefail; sudo() { "$@"; }; export CXXFLAGS=-Werror DEB_BUILD_OPTIONS="nocheck parallel=2"'
  echo 'echo "APT::Get::Assume-Yes true; APT::Install-Recommends false;" >/etc/apt/apt.conf.d/90yes; apt-get update -qq'
  awk '/^```/ { inside = ($0 == "```sh building"); next } inside' "$source/README.md"
  echo 'cmake --build --preset release; ctest --preset release -L unit; test -s frames/0024.png; /usr/local/bin/pprt-render --version; test -s ../pprt_*.deb'
} >building.sh
[[ $(grep -c 'cmake\|scripts/demo\|dpkg-buildpackage' building.sh) -ge 5 ]] || { echo 'the README hardly tells how to build'; exit 1; }
"$source/scripts/bare-debian" -a building.sh "$suite" bash building.sh

#!/usr/bin/env bash
# builds.sh SOURCE_DIR SUITE: on a bare Debian system the sources build with warnings as errors and pass the unit tests;
# the package that they give there installs, runs and goes on another.
set -euo pipefail
source=$1 suite=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$source/scripts/bare-debian" -f 'build/dev/pprt_*.deb' "$suite" sh -c '
  scripts/setup && apt-get install -qq -y --no-install-recommends dpkg-dev file >/dev/null &&
  cmake --preset dev >/dev/null && cmake --build --preset dev && ctest --preset dev -L unit &&
  cd build/dev && cpack -G DEB'
"$source/scripts/bare-debian" -a "$(echo "$scratch"/pprt_*.deb)" "$suite" tests/package/in_bare_debian.sh

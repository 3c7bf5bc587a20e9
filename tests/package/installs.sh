#!/usr/bin/env bash
# installs.sh SOURCE_DIR BUILD_DIR SUITE: the package that CPack makes of the build has no errors in lintian's eyes, and
# installs, runs and goes on a bare Debian system.
set -euo pipefail
source=$1 build=$2 suite=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
(cd "$build" && cpack -G DEB -B "$scratch") >cpack.log 2>&1 || { cat cpack.log; exit 1; }
if command -v lintian >/dev/null; then
  lintian --fail-on error --allow-root ./*.deb || { echo 'package: lintian has errors'; exit 1; }
else
  echo 'package: lintian is not installed: it is not asked'
fi
"$source/scripts/bare-debian" -a "$(echo "$scratch"/pprt_*.deb)" "$suite" tests/package/in_bare_debian.sh

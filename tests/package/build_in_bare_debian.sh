#!/usr/bin/env bash
# Run by scripts/package in a bare Debian system. Builds the package with what debian/control names and nothing else, and
# runs the unit tests. Fails when lintian finds a fault. Leaves packages/ with all that was built.
source "$(dirname "$0")/lib.sh"
quietly apt-get update
quietly apt-get build-dep -y --no-install-recommends ./
did "build dependencies installed"
dpkg-buildpackage --no-sign -j2 >/tmp/log 2>&1 || { grep -A 20 '^FAILED' /tmp/log >&2 || tail -n 100 /tmp/log >&2; fail 'dpkg-buildpackage failed'; }
grep '^100% tests passed' /tmp/log || fail 'no unit tests have run'
did "built and tested"
mkdir packages
mv ../pprt* packages/

quietly apt-get install -y --no-install-recommends lintian
did "lintian installed"
lintian --version
lintian --verbose --display-info --display-experimental --pedantic --show-overrides --fail-on none packages/pprt_*.changes |
  tee /tmp/lintian
# Remarks of kind X are lintian's experiments. Two others are no faults of the package: the lintian of an older Debian does
# not know the policy that it follows, and lintian finds misspelt words in machine code. Those of the sources count.
while read -r line; do
  [[ $line =~ ^[EWIPO]:\ pprt[^:]*:\ ([^ ]+)\ ?([^ ]*) ]] || continue
  case ${BASH_REMATCH[1]} in
    newer-standards-version) continue ;;
    spelling-error-in-binary) grep -rqwF -e "${BASH_REMATCH[2]}" src || continue ;;
  esac
  fail "lintian finds a fault: $line"
done </tmp/lintian
did "lintian finds no fault"

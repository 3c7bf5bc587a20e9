# shellcheck shell=bash
# Shared by what scripts/package runs in a bare Debian system. The scripts run as root beside the package's sources.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
fail() { echo "package: $1" >&2; exit 1; }
quietly() { "$@" >/tmp/log 2>&1 || { cat /tmp/log >&2; fail "'$*' failed"; }; }

# did TEXT: prints the seconds since the last call.
did() {
  echo "package: $1: ${SECONDS} s" >&2
  SECONDS=0
}

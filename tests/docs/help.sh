#!/usr/bin/env bash
# help.sh PROGRAM [SUBCOMMAND...]: help fits a terminal of 80 columns, and each of its groups a screen of 24 lines.
set -euo pipefail
program=$1
shift
for subcommand in "" "$@"; do
  # shellcheck disable=SC2086
  "$program" $subcommand --help | awk -v name="${program##*/} $subcommand" '
    length($0) > 79 { print name ": more than 79 columns: " $0; bad = 1 }
    { ++lines } /^$/ { lines = 0; ++groups }
    lines > 23 { print name ": more than a screen, at: " $0; bad = 1 }
    END { exit bad || groups < 1 }'
done

#!/usr/bin/env bash
# help.sh PROGRAM [SUBCOMMAND...]: help fits a terminal of 80 columns, and each of its groups a screen of 24 lines.
set -euo pipefail
program=$1
shift
for words in --help "--help all" "${@/%/ --help}"; do
  # shellcheck disable=SC2086
  "$program" $words | awk -v name="${program##*/} $words" '
    length($0) > 79 { print name ": more than 79 columns: " $0; bad = 1 }
    { ++lines } /^$/ { lines = 0; ++groups }
    lines > 23 { print name ": more than a screen, at: " $0; bad = 1 }
    END { exit bad || groups < 1 }'
done

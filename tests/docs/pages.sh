#!/usr/bin/env bash
# pages.sh MAN_DIRECTORY GROFF: every man page fits a screen of 80 columns; man leaves two of them free. A page that is too
# wide is the control.
set -euo pipefail
groff=$2
problems_of() { "$groff" -mdoc -Tutf8 -ww -rLL=78n "$1" 2>&1 >/dev/null; }

cells='0123456789 Ta 0123456789 Ta 0123456789 Ta 0123456789 Ta 0123456789 Ta 0123456789 Ta 0123456789 Ta 0123456789'
wide=$(mktemp)
trap 'rm -f "$wide"' EXIT
{
  printf '%s\n' '.Dd January 1, 2026' '.Dt WIDE 1' '.Os' '.Sh NAME' '.Nm wide' '.Nd a page that is too wide'
  printf '%s\n' '.Bl -column "01234567" "01234567" "01234567" "01234567" "01234567" "01234567" "01234567" "01234567"'
  printf '%s\n' ".It $cells" '.El'
} >"$wide"
[[ -n $(problems_of "$wide") ]] || { echo 'pages: a page that is too wide passes' >&2 && exit 1; }

status=0
for page in "$1"/*.[15]; do
  problems=$(problems_of "$page")
  [[ -z $problems ]] && continue
  echo "$problems" >&2
  status=1
done
exit "$status"

#!/usr/bin/env bash
# check.sh: every scene in this directory has the outcome in outcomes.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
diff <(sort "$here/outcomes.txt") <(bash "$here/score.sh" "$here"/*.nff | cut -d' ' -f1,2 | sort) ||
  { echo "wild: outcomes (>) are not those expected (<)"; exit 1; }

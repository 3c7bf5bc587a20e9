#!/usr/bin/env bash
# format.sh SOURCE_DIR CLANG_FORMAT: the sources stand as clang-format puts them.
set -euo pipefail
cd "$1"
find src tests bench -name '*.h' -o -name '*.cpp' | xargs "$2" --dry-run -Werror

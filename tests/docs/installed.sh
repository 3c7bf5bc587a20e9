#!/usr/bin/env bash
# installed.sh SOURCE_DIR BUILD_DIR: `cmake --install` puts all files of the examples in place, and nothing that somebody
# has made by working through one where it stands.
set -euo pipefail
source=$1 build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# The files under version control, or all where there is none.
files=$(cd "$source" && { git ls-files examples 2>/dev/null | grep . || find examples -type f; })
(cd "$source" && xargs -d '\n' cp --parents -t "$scratch" <<<"$files")
mkdir "$scratch/examples/accuracy/study"
touch "$scratch/examples/accuracy/lamp.png" "$scratch/examples/accuracy/study/index.html"

# The build's own rules, for examples that stand in the scratch directory.
sed "s,$source/examples,$scratch/examples,; /MANIFEST/s,$build,$scratch," "$build/cmake_install.cmake" >"$scratch/rules.cmake"
cmake -DCMAKE_INSTALL_PREFIX="$scratch/installed" -P "$scratch/rules.cmake" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
cd "$scratch/installed/share/doc/pprt"
diff <(sort <<<"$files") <(find examples -type f | sort)

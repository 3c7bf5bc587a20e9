#!/usr/bin/env bash
# versions.sh SOURCE_DIR BUILD_DIR: everything that names a version names that of project() in CMakeLists.txt.
set -euo pipefail
source=$1 build=$2
version=$(sed -n 's/^project(pprt VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || { echo "CMakeLists.txt: the version is '$version'"; exit 1; }
failures=0
# expect WHERE FOUND: what stands there is the version.
expect() {
  [[ $2 == "$version" ]] || { echo "$1: the version is '$2', that of CMakeLists.txt is $version"; failures=$((failures + 1)); }
}

expect debian/changelog "$(sed -n '1s/^pprt (\(.*\)) .*/\1/p' "$source/debian/changelog")"
expect CHANGELOG.md "$(sed -n 's/^## \([^, ]*\).*/\1/p' "$source/CHANGELOG.md" | head -n 1)"
expect CITATION.cff "$(sed -n 's/^version: //p' "$source/CITATION.cff")"
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  expect "$program --version" "$("$build/bin/$program" --version | sed "s/^$program //")"
done
for page in "$source"/man/*.[15]; do
  name=${page##*/}
  expect "$name as installed" "$(gzip -dc "$build/man/$name.gz" | sed -n 's/^\.Os pprt //p')"
done
[[ $failures -eq 0 ]]

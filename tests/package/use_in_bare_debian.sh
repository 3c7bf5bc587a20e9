#!/usr/bin/env bash
# Run by scripts/package beside the package, in a bare Debian system. Installs it, uses it as its users would, removes and
# purges it. Then runs the tests of debian/tests.
source "$(dirname "$0")/lib.sh"
package=$(echo "$PWD"/pprt_*.deb)
quietly apt-get update
SECONDS=0
quietly apt-get install -y --no-install-recommends "$package"
did "installed"
version=$(dpkg-query --show --showformat '${Version}' pprt)
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  [[ $($program --version) == "$program $version" ]] || fail "$program --version: $($program --version)"
done
# An address that is nobody's.
[[ $(dpkg-query --show --showformat '${Maintainer}' pprt) == *'.invalid>' ]] || fail 'the maintainer has an address'

mkdir /tmp/use
cd /tmp/use
pprt-render spd:tree --fps 4 -np 2
[[ $(head -c 4 frame_0001.png | tail -c 3) == PNG ]] || fail 'no picture came out'
pprt-render /usr/share/doc/pprt/scenes/demo.anim --frames 1-2 -np 3 -o out/%04d.exr --stats ledger.ndjson
[[ $(ls out/*.exr | wc -l) -eq 2 && $(wc -l <ledger.ndjson) -eq 4 ]] || fail 'the demo made no two frames'
pprt-convert spd:tree:5 tree.nff
pprt-convert tree.nff tree.glb
pprt-compare frame_0001.png frame_0001.png --max-error 0 >/dev/null

# Completion stands where the shells look.
bash -c 'source /usr/share/bash-completion/completions/pprt-render && complete -p pprt-render' >/dev/null ||
  fail 'bash is not told how to complete'

# Manual pages; a bare system has nothing to show them with.
quietly apt-get install -y --no-install-recommends man-db
for page in pprt-render.1 pprt-convert.1 pprt-compare.1 pprt-study.1 pprt-anim.5; do
  name=${page%.*} section=${page##*.}
  MANWIDTH=80 man -P cat "$section" "$name" >page 2>problems || fail "man shows no $page: $(cat problems)"
  [[ ! -s problems ]] || fail "$page: $(cat problems)"
  grep -q '^NAME' page && grep -q "${name^^}($section)" page && grep -q "^pprt $version " page ||
    fail "$page does not look like a manual page"
done

did "used"

# Nothing stays: neither after removal nor after purging. What man has rendered is its own.
cd /
dpkg-query --listfiles pprt | sort >/tmp/files
[[ $(wc -l </tmp/files) -gt 30 ]] || fail "the package has only $(wc -l </tmp/files) files"
expect_gone() {
  local left
  left=$(find / -xdev -name '*pprt*' -not -path '/tmp/*' -not -path '/src/*' -not -path '/proc/*' -not -path '/var/cache/man/*')
  [[ -z $left ]] || fail "left behind: $left"
}
quietly apt-get remove -y pprt
expect_gone
quietly dpkg --purge pprt
if dpkg-query --status pprt >/dev/null 2>&1; then fail 'it is still known'; fi
expect_gone
did "removed and purged"

cd /src
quietly apt-get install -y --no-install-recommends autopkgtest
did "autopkgtest installed"
autopkgtest --output-dir /tmp/autopkgtest "$package" pprt_*.dsc -- null >/tmp/log 2>&1 || { cat /tmp/log >&2; fail 'autopkgtest fails'; }
cat /tmp/autopkgtest/summary
grep -q '^demo  *PASS' /tmp/autopkgtest/summary || fail 'autopkgtest ran no demo'
did "autopkgtest passed"
echo "package: installed, used, removed and tested on Debian $(cat /etc/debian_version)"

#!/usr/bin/env bash
# in_bare_debian.sh: run by scripts/bare-debian beside the package, as root of a system that has nothing else. Installs
# it, uses it as its users would, and removes it.
set -euo pipefail
fail() { echo "package: $1" >&2; exit 1; }
package=$(echo "$PWD"/pprt_*.deb)
export DEBIAN_FRONTEND=noninteractive

quietly() { "$@" >/tmp/log 2>&1 || { cat /tmp/log >&2; fail "'$*' failed"; }; }
quietly apt-get update
quietly apt-get install -y --no-install-recommends "$package"
version=$(dpkg-query --show --showformat '${Version}' pprt)
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  [[ $($program --version) == "$program ${version%-*}" ]] || fail "$program --version: $($program --version)"
done
# An address that is nobody's.
[[ $(dpkg-query --show --showformat '${Maintainer}' pprt) == *'.invalid>' ]] || fail 'the maintainer has an address'

mkdir /tmp/use
cd /tmp/use
pprt-render spd:tree --fps 4 -np 2
[[ $(head -c 4 frame_0001.png | tail -c 3) == PNG ]] || fail 'no picture came out'
pprt-render /usr/share/doc/pprt/examples/demo.anim --frames 1-2 -np 3 -o out/%04d.exr --stats ledger.ndjson
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
  grep -q '^NAME' page && grep -q "${name^^}($section)" page || fail "$page does not look like a manual page"
done

# Away with it: nothing stays but what is not its own.
cd /
dpkg-query --listfiles pprt | sort >/tmp/files
[[ $(wc -l </tmp/files) -gt 30 ]] || fail "the package has only $(wc -l </tmp/files) files"
quietly apt-get purge -y pprt
if dpkg-query --status pprt >/dev/null 2>&1; then fail 'it is still known'; fi
# What man has rendered is its own.
left=$(find / -xdev -name '*pprt*' -not -path '/tmp/*' -not -path '/src/*' -not -path '/proc/*' -not -path '/var/cache/man/*')
[[ -z $left ]] || fail "left behind: $left"
echo "package: installed, used and removed on Debian $(cat /etc/debian_version)"

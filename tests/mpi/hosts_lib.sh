# Shared by the tests on several hosts, which are namespaces of this machine on one bridge: network, name and /tmp of
# their own. A test calls own_network first and then make_hosts.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# own_network SCRIPT ARGUMENTS: begins the script anew as the first host. Exits with 77 (skipped) where this machine
# does not allow namespaces.
own_network() {
  local own=(unshare --net --uts --mount)
  if [[ -n ${PPRT_OWN_NETWORK:-} ]]; then return; fi
  if [[ $(id -u) != 0 ]]; then own+=(--map-root-user); fi
  # /mnt holds what all hosts see, the programs too: those may lie in /tmp.
  "${own[@]}" sh -c 'ip link add bridge0 type bridge && mount -t tmpfs none /mnt' 2>/dev/null || {
    echo "$(basename "$1"): no networks of one's own here" >&2
    exit 77
  }
  local programs
  programs=$(dirname "$(command -v pprt-render)")
  PPRT_OWN_NETWORK=1 exec "${own[@]}" sh -c 'mount -t tmpfs none /mnt && mkdir /mnt/bin && mount --bind "$1" /mnt/bin &&
    shift && TMPDIR=/mnt PATH=/mnt/bin:$PATH exec bash "$@"' sh "$programs" "$@"
}

# make_hosts COUNT: hosts 10.84.0.1 to COUNT, named host1 and so on. The first is this process's own.
make_hosts() {
  local host holder
  ip link set lo up
  ip link add bridge0 type bridge
  ip addr add 10.84.0.1/24 dev bridge0
  ip link set bridge0 up
  hostname host1
  holders=()
  trap 'kill "${holders[@]}" $daemons 2>/dev/null; rm -rf "$work"' EXIT
  daemons=
  for ((host = 2; host <= $1; ++host)); do
    unshare --net --uts --mount sh -c "mount -t tmpfs none /tmp && touch $work/ready.$host && exec sleep 300" &
    holder=$!
    holders+=("$holder")
    until [[ -e $work/ready.$host ]]; do sleep 0.01; done
    ip link add "port$host" type veth peer name eth0 netns $holder
    ip link set "port$host" master bridge0 up
    printf 'nsenter --target %s --net --uts --mount --wd=%s --\n' $holder "$work" >"enter.10.84.0.$host"
    on_host "$host" sh -c "hostname host$host; ip link set lo up; ip addr add 10.84.0.$host/24 dev eth0; ip link set eth0 up"
  done
}

# on_host NUMBER COMMAND...
on_host() {
  local host=$1
  shift
  # shellcheck disable=SC2046 # words
  if [[ $host == 1 ]]; then "$@"; else $(cat "$work/enter.10.84.0.$host") "$@"; fi
}

# Lets mpirun enter the hosts instead of using ssh, and writes the hostfile "hosts".
enter_by_mpirun() {
  local host
  printf '#!/bin/sh\nenter=$(cat "%s/enter.$1")\nshift\nexec $enter sh -c "$*"\n' "$work" >agent
  chmod +x agent
  export OMPI_MCA_plm_rsh_agent=$work/agent
  for ((host = 1; host <= ${#holders[@]} + 1; ++host)); do echo "10.84.0.$host slots=1"; done >hosts
}

# expect_ranks LEDGER NUMBER
expect_ranks() {
  grep -q "\"ranks\":$2" "$1" || { head -c 600 "$1" >&2; fail "the ledger does not tell of $2 ranks"; }
}

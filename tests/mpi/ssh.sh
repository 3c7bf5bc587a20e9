#!/usr/bin/env bash
# Runs on three hosts that mpirun reaches by ssh. Two of them have a second network each, with equal addresses and no
# way from one to the other, as docker0 has.
# Exits with 77 (skipped) where the ssh server is missing (package openssh-server) or a test may not make networks.
source "$(dirname "$0")/hosts_lib.sh"
PATH+=:/usr/sbin
[[ $(id -u) == 0 ]] || { echo "ssh: only root may be a server here" >&2; exit 77; }
command -v sshd >/dev/null || { echo "ssh: sshd is missing" >&2; exit 77; }
own_network "$here/ssh.sh"
make_hosts 3

mkdir -p /run/sshd ssh
chmod 700 ssh
ssh-keygen -q -t ed25519 -N '' -f ssh/host
ssh-keygen -q -t ed25519 -N '' -f ssh/user
cat >ssh/server <<END
HostKey $work/ssh/host
AuthorizedKeysFile $work/ssh/user.pub
PermitRootLogin yes
StrictModes no
UsePAM no
PidFile none
SetEnv PATH=$PATH
END
cat >ssh/client <<END
IdentityFile $work/ssh/user
StrictHostKeyChecking no
UserKnownHostsFile /dev/null
LogLevel ERROR
END
for host in 2 3; do
  on_host $host "$(command -v sshd)" -D -e -f "$work/ssh/server" >"ssh/log.$host" 2>&1 &
  daemons+=" $!"
done
export OMPI_MCA_plm_rsh_args="-F $work/ssh/client"
for host in 1 2 3; do echo "10.84.0.$host slots=1"; done >hosts
for ((i = 0; i < 100; ++i)); do
  if ssh -F ssh/client 10.84.0.2 true 2>/dev/null && ssh -F ssh/client 10.84.0.3 true 2>/dev/null; then break; fi
  sleep 0.1
done
[[ $i -lt 100 ]] || { cat ssh/log.* >&2; fail "no ssh to the hosts"; }

render() {
  local dir=$1
  shift
  timeout 40 pprt-render spd:tree:5 "$here/moving.anim" -np 3 --hostfile hosts --clock work --frames 1-4 --progress none \
    -o "$dir/%04d.png" --stats "$dir.ndjson" "$@"
}

render plain 2>told || { cat told >&2; fail "the run by ssh failed"; }
[[ ! -s told ]] || { cat told >&2; fail "something was said"; }
expect_frames plain png 4
expect_ranks plain.ndjson 3
for host in 2 3; do
  on_host $host sh -c 'ip link add docker0 type bridge; ip addr add 172.17.0.1/16 dev docker0; ip link set docker0 up'
done
code=0
render second 2>told || code=$?
[[ $code == 1 ]] || { cat told >&2; fail "hosts that do not reach each other: code $code"; }
grep -q 'error: host[23] gets no answer from process [12] within 15 s; networks here: .*10.84.0.0/24 (eth0).*172.17.0.0/16 (docker0)' told &&
  grep -q 'export OMPI_MCA_btl_tcp_if_include=' told || { cat told >&2; fail "nobody gave advice"; }
export OMPI_MCA_btl_tcp_if_include=10.84.0.0/24
render second 2>told || { cat told >&2; fail "the advice does not help"; }
expect_frames second png 4
for file in plain/????.png; do cmp "$file" "second/${file##*/}" || fail "the frames differ"; done

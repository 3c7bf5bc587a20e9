#!/usr/bin/env bash
# Runs under Slurm on two hosts: sbatch with pprt-render's own mpirun, and srun with one process a task.
# Exits with 77 (skipped) where Slurm is missing (packages slurm-wlm and munge) or a test may not make networks.
source "$(dirname "$0")/hosts_lib.sh"
PATH+=:/usr/sbin
[[ $(id -u) == 0 ]] || { echo "slurm: only root may be a server here" >&2; exit 77; }
for program in slurmctld slurmd munged; do
  command -v $program >/dev/null || { echo "slurm: $program is missing" >&2; exit 77; }
done
own_network "$here/slurm.sh"
make_hosts 2

mkdir munge state
chmod 755 "$work" munge
head -c 32 /dev/urandom >key
chmod 600 key
munged --force --foreground --key-file="$work/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --seed-file="$work/munge/seed" --log-file="$work/munge/log" >munged.log 2>&1 &
daemons=$!
cat >slurm.conf <<END
ClusterName=trial
SlurmctldHost=host1(10.84.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/%n
SlurmctldPidFile=$work/controller.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/controller.log
SlurmdLogFile=$work/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
NodeName=host1 NodeAddr=10.84.0.1 CPUs=2
NodeName=host2 NodeAddr=10.84.0.2 CPUs=2
PartitionName=all Nodes=host1,host2 Default=YES OverSubscribe=FORCE MaxTime=5 State=UP
END
export SLURM_CONF=$work/slurm.conf
start_daemon() { "$@" >>daemons.log 2>&1 & daemons+=" $!"; }
start_daemon slurmctld -D -i
start_daemon slurmd -D -N host1
start_daemon on_host 2 slurmd -D -N host2
for ((i = 0; i < 200; ++i)); do
  if [[ $(sinfo --noheader --states=idle --format=%D 2>/dev/null) == 2 ]]; then break; fi
  sleep 0.1
done
[[ $i -lt 200 ]] || { tail -n 20 ./*.log >&2; fail "Slurm's two hosts are not there"; }

# The commands of the manual.
cat >film.sh <<'END'
#!/bin/sh
#SBATCH --nodes=2 --ntasks=4
pprt-render spd:tree:5 moving.anim --frames 1-4 --clock work -np 4 -o 'batch/%04d.png' --stats batch.ndjson
END
cp "$here/moving.anim" .
sbatch --wait --output=batch.log film.sh >/dev/null || { cat batch.log >&2; fail "sbatch failed"; }
expect_frames batch png 4
expect_ranks batch.ndjson 4

srun --mpi=pmix --nodes=2 --ntasks=4 pprt-render spd:tree:5 moving.anim --frames 1-4 --clock work \
  -o 'tasks/%04d.png' --stats tasks.ndjson >tasks.log 2>&1 || { cat tasks.log >&2; fail "srun failed"; }
expect_frames tasks png 4
expect_ranks tasks.ndjson 4

srun --mpi=pmix --nodes=2 --ntasks=2 --ntasks-per-node=1 --cpus-per-task=2 pprt-render spd:tree:5 moving.anim --threads 2 \
  --frames 1-4 --clock work -o 'threads/%04d.png' --stats threads.ndjson >threads.log 2>&1 ||
  { cat threads.log >&2; fail "srun with threads failed"; }
expect_ranks threads.ndjson 4
[[ $(grep -c 'launch task' host2.log) -ge 3 ]] || fail "the second host had nothing to do"
for file in batch/????.png; do
  for other in tasks threads; do
    cmp "$file" "$other/${file##*/}" || fail "the frames of $other differ"
  done
done

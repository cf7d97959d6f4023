#!/usr/bin/env bash
# Runs a command beside a Slurm of one node on the loopback, and stops that Slurm afterwards. Needs root and Debian's
# slurm-wlm and munge.
#   slurm_one_node.sh COMMAND ...
set -euo pipefail

folder=$(mktemp -d)
host=$(hostname -s)
stop() {
  pkill -F "$folder/slurmd.pid" 2>/dev/null || true
  pkill -F "$folder/slurmctld.pid" 2>/dev/null || true
  pkill -F "$folder/munged.pid" 2>/dev/null || true
  sleep 1
  rm -rf "$folder"
}
trap stop EXIT

# Munge proves to the controller who sends a job; its key and socket are this run's own.
install -d -m 755 "$folder/munge"
dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
chmod 600 "$folder/munge.key"
chmod 755 "$folder"
munged --force --key-file="$folder/munge.key" --socket="$folder/munge/socket" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"

cat >"$folder/slurm.conf" <<EOF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
EOF
mkdir "$folder/state" "$folder/spool"
export SLURM_CONF=$folder/slurm.conf
slurmctld -f "$SLURM_CONF"
slurmd -f "$SLURM_CONF"
for _ in $(seq 60); do
  sinfo -h -o %t 2>/dev/null | grep -q idle && break
  sleep 0.5
done
sinfo -h -o %t | grep -q idle || { tail -n 5 "$folder"/slurm*.log >&2; echo "slurm_one_node.sh: no node became idle" >&2; exit 1; }
"$@"

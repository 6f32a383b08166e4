#!/usr/bin/env bash
# A real Slurm of two nodes on this machine, for one command: slurm.sh FOLDER COMMAND…
#
# Needs the Debian packages slurm-wlm and munge, and root. While the command runs, node n2 is lost with all of its
# processes as soon as the file FOLDER/lose-n2 exists, and comes back after a few seconds. FOLDER/lost-n2 then holds the
# number of the array task that ran on it. Everything that this script starts ends with it.
set -euo pipefail

folder=$1
shift
mkdir -p "$folder/state" "$folder/munge"
export SLURM_CONF=$folder/slurm.conf

cat > "$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=localhost
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket,cred_expire=5
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
AccountingStorageType=accounting_storage/none
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
SlurmctldPort=16817
SlurmdTimeout=10
MessageTimeout=10
NodeName=n1 NodeHostname=localhost Port=17001 CPUs=1 RealMemory=8000
NodeName=n2 NodeHostname=localhost Port=17002 CPUs=1 RealMemory=8000
PartitionName=main Nodes=n1,n2 Default=YES State=UP
CONF
mkdir -p "$folder/spool-n1" "$folder/spool-n2"

pids=()
# Process ids of what runs on this cluster, told by its environment; with the name of a node, of its jobs only.
processes() {
  local file
  for file in /proc/[0-9]*/environ; do
    if grep -qzxF "SLURM_CONF=$SLURM_CONF" "$file" && { [ $# = 0 ] || grep -qzxF "SLURMD_NODENAME=$1" "$file"; }; then
      file=${file#/proc/}
      echo "${file%/environ}"
    fi
  done 2>/dev/null
}
end() {
  local pid
  for pid in "$@"; do
    [ "$pid" = $$ ] || [ "$pid" = "$BASHPID" ] || [ "$pid" = "$PPID" ] || kill -9 "$pid" 2>/dev/null || true
  done
}
finish() {
  end "${pids[@]}"
  end $(processes)
}
trap finish EXIT

head -c 1024 /dev/urandom > "$folder/munge/key"
chmod 700 "$folder/munge" && chmod 600 "$folder/munge/key"
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
  --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" &
pids+=($!)
for _ in $(seq 100); do [ -S "$folder/munge/socket" ] && break; sleep 0.1; done
slurmctld -D > "$folder/slurmctld.out" 2>&1 &
pids+=($!)
node() {
  slurmd -D -N "$1" > "$folder/slurmd-$1.out" 2>&1 &
  pids+=($!)
  last=$!
}
node n1
node n2
n2=$last
for _ in $(seq 300); do [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ] && break; sleep 0.1; done
sinfo

lose_n2() {
  while [ ! -e "$folder/lose-n2" ]; do sleep 0.2; done
  # The daemons of the node end before its jobs: a daemon that sees a job end reports that, and no node is lost.
  local jobs pid parent daemons=("$n2")
  squeue --noheader --nodelist=n2 --format=%K > "$folder/on-n2"
  jobs=$(processes n2)
  for pid in $jobs; do
    parent=$(ps -o ppid= -p "$pid" | tr -d ' ')
    [ "$(cat "/proc/$parent/comm" 2>/dev/null)" = slurmstepd ] && daemons+=("$parent")
  done
  end "${daemons[@]}"
  end $jobs
  mv "$folder/on-n2" "$folder/lost-n2"
  sleep 15
  slurmd -D -N n2 > "$folder/slurmd-n2.out" 2>&1
}
lose_n2 &
pids+=($!)

"$@"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A Slurm cluster of this machine alone, to try farm_slurm.sh on. As root, on Debian 12 or Ubuntu.
#
#   tools/scripts/one_machine_slurm.sh start FOLDER   installs slurm-wlm and munge if missing, starts them
#   export SLURM_CONF=FOLDER/slurm.conf               then sbatch, squeue ... use it
#   tools/scripts/one_machine_slurm.sh stop FOLDER    ends what start has started, and waits for it
#
# All its files, also the key and the socket of its own munged, are in the folder.
set -euo pipefail

(($# == 2)) || { sed -n '5,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
folder=$(realpath -m "$2")

start() {
  if ! command -v slurmctld >/dev/null || ! command -v munged >/dev/null; then
    apt-get update -q
    DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends slurm-wlm munge
  fi
  mkdir -p "$folder/state" "$folder/spool"
  [[ -e $folder/munge.key ]] || mungekey --create --keyfile="$folder/munge.key"
  # --force: the folder may be below one that not everybody may enter.
  munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"
  cat > "$folder/slurm.conf" <<CONF
ClusterName=local
SlurmctldHost=$(hostname -s)(127.0.0.1)
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=local Nodes=ALL Default=YES State=UP
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
CONF
  export SLURM_CONF=$folder/slurm.conf
  slurmctld
  slurmd
  for _ in {1..30}; do
    [[ $(sinfo -h -o %T 2>/dev/null) == idle ]] && return
    sleep 1
  done
  echo "The machine does not become idle; see $folder/slurmctld.log" >&2
  exit 1
}

stop() {
  local daemon pid
  for daemon in slurmd slurmctld munged; do
    pid=$(cat "$folder/$daemon.pid" 2>/dev/null) || continue
    kill "$pid" 2>/dev/null || true
    for _ in {1..100}; do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
  done
}

case $1 in
  start|stop) "$1" ;;
  *) echo "one_machine_slurm.sh: unknown action $1" >&2; exit 2 ;;
esac

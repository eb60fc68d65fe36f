#!/usr/bin/env bash
# A Slurm of its own on this machine: munge, a controller and two nodes of two cores, all in one folder, beside whatever
# Slurm the machine may have. Needs root and Debian's munge and slurm-wlm.
# Usage: tests/slurm_cluster.sh start|stop|restart-controller|lose-node N|return-node N FOLDER
#   `start` prints the setting of SLURM_CONF that the tools need.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '4,5s/^# //p' "$0" >&2; exit 2; }
action=$1
folder=$(realpath -m "${@: -1}")
export SLURM_CONF=$folder/slurm.conf
max_array_size=21  # small, so that arrays are split

# kill_of FILE [SIGNAL]: ends the process whose number the file holds, and waits for that.
kill_of() {
  local process
  process=$(cat "$1" 2>/dev/null) || return 0
  kill "${2:--TERM}" "$process" 2>/dev/null || return 0
  for _ in $(seq 100); do kill -0 "$process" 2>/dev/null || return 0; sleep 0.1; done
  kill -KILL "$process" 2>/dev/null || true
}

write_configuration() {
  local host=$1
  cat >"$SLURM_CONF" <<EOF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$((port))
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/controller.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/controller.log
SlurmdLogFile=$folder/%n.log
AuthType=auth/munge
AuthInfo=socket=$folder/munge.sock
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=2,sched_min_interval=200000,batch_sched_delay=0
SelectType=select/cons_res
SelectTypeParameters=CR_Core_Memory
MaxArraySize=$max_array_size
ReturnToService=2
SlurmdTimeout=10
MinJobAge=300
KillWait=2
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2 RealMemory=16000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2 RealMemory=16000
PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
EOF
}

start_node() {
  slurmd -N "$1"
}

case $action in
  start)
    mkdir -p "$folder/state"
    port=$((20000 + RANDOM % 10000))
    write_configuration "$(hostname)"
    (umask 077 && head -c 1024 /dev/urandom >"$folder/munge.key")
    munged --force --key-file="$folder/munge.key" --socket="$folder/munge.sock" --pid-file="$folder/munged.pid" \
      --log-file="$folder/munged.log" --seed-file="$folder/munge.seed" >/dev/null 2>&1
    slurmctld -c
    start_node n1
    start_node n2
    for _ in $(seq 150); do
      if [ "$(sinfo --noheader --Node --format=%t 2>/dev/null | grep -c idle)" = 2 ]; then
        echo "SLURM_CONF=$SLURM_CONF"
        exit 0
      fi
      sleep 0.2
    done
    echo "the nodes do not come up" >&2
    exit 1
    ;;
  restart-controller)
    kill_of "$folder/controller.pid"
    sleep 3
    slurmctld
    ;;
  lose-node)
    # As if its power had failed: the daemon is gone, and with it all that ran there.
    kill_of "$folder/$2.pid" -KILL
    for process in $(grep -lz "^SLURMD_NODENAME=$2$" /proc/[0-9]*/environ 2>/dev/null | cut -d/ -f3); do
      parent=$(sed -n 's/^PPid:[^0-9]*//p' "/proc/$process/status" 2>/dev/null) || continue
      [ "$(cat "/proc/$parent/comm" 2>/dev/null)" != slurmstepd ] || kill -KILL "$parent" 2>/dev/null || true
      kill -KILL "$process" 2>/dev/null || true
    done
    scontrol update NodeName="$2" State=DOWN Reason="test: power failure"
    ;;
  return-node)
    start_node "$2"
    scontrol update NodeName="$2" State=RESUME 2>/dev/null || true
    ;;
  stop)
    scancel --quiet --user=root 2>/dev/null || true
    for daemon in n1 n2 controller munged; do kill_of "$folder/$daemon.pid"; done
    ;;
  *) sed -n '4,5s/^# //p' "$0" >&2; exit 2 ;;
esac

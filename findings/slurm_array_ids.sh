#!/usr/bin/env bash
# In Slurm the last task of an array has the array's own job id, and a job that is no array has task 4294967294 in file names.
#
# Version:   slurmctld, slurmd and slurm-client 22.05.8-4+deb12u3, munge (Debian 12; installed if missing; needs root)
# Guess:     the first task has the number that sbatch prints as its SLURM_JOB_ID, and %a is 0 or empty outside of arrays.
# Behaviour: the tasks that start first get new numbers, and the last one keeps the array's. %a outside of arrays is
#            4294967294.
# Matters:   folders for temporary files that are named after SLURM_JOB_ID, or logs looked up by the number that was printed,
#            belong to the last variation, not to the first. One script for single materials and for arrays needs two
#            patterns.
# Seen on 2026-11-27:
#   ids of the tasks 0 to 3, as distance from the array's: 1 2 3 0
#   file of a job with --output=log-%a.txt: log-4294967294.txt
. "$(dirname "$0")/common/packages.bash"
[ "$(id -u)" = 0 ] || skip "this needs root"
version=22.05.8-4+deb12u3
for package in slurmctld slurmd slurm-client; do
  [ "$(dpkg-query -W -f '${Version}' $package 2>/dev/null)" = $version ] ||
    apt-get install -y -qq --no-install-recommends munge slurmctld=$version slurmd=$version slurm-client=$version \
      >apt.log 2>&1 || skip "no $package of $version"
done

# A Slurm of its own in the temporary folder, of one node.
port=$((20000 + RANDOM % 10000))
export SLURM_CONF=$dir/slurm.conf
mkdir state
cat >slurm.conf <<EOF
ClusterName=finding
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/controller.pid
SlurmdPidFile=$dir/node.pid
SlurmctldLogFile=$dir/controller.log
SlurmdLogFile=$dir/node.log
AuthType=auth/munge
AuthInfo=socket=$dir/munge.sock
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SchedulerType=sched/builtin
SelectType=select/cons_res
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
PartitionName=main Nodes=n1 Default=YES State=UP
EOF
stop() {
  local file
  for file in node.pid controller.pid munged.pid; do
    [ ! -s "$dir/$file" ] || kill "$(cat "$dir/$file")" 2>/dev/null
  done
  sleep 2
  rm -rf "$dir"
}
trap stop EXIT
(umask 077 && head -c 1024 /dev/urandom >munge.key)
chmod 755 .
munged --force --key-file="$dir/munge.key" --socket="$dir/munge.sock" --pid-file="$dir/munged.pid" \
  --log-file="$dir/munged.log" --seed-file="$dir/munge.seed" >/dev/null 2>&1 || skip "munge does not start"
slurmctld -c >/dev/null 2>&1 && slurmd -N n1 >/dev/null 2>&1 || skip "Slurm does not start"
for _ in $(seq 150); do
  sinfo --noheader --format=%t 2>/dev/null | grep -q idle && break
  sleep 0.2
done
sinfo --noheader --format=%t 2>/dev/null | grep -q idle || skip "the node does not come up"
for variable in ${!SBATCH_@}; do unset "$variable"; done

printf '#!/bin/bash\necho "$SLURM_ARRAY_TASK_ID $((SLURM_JOB_ID - SLURM_ARRAY_JOB_ID))"\n' >task.sh
printf '#!/bin/bash\n' >plain.sh
timeout 120 sbatch --wait --array=0-3 --output=task-%a.txt task.sh >said 2>&1 || skip "the array does not run"
timeout 60 sbatch --wait --output=log-%a.txt plain.sh >said 2>&1 || skip "the job does not run"
expect "ids of the tasks 0 to 3, as distance from the array's" "$(cut -d ' ' -f 2 task-[0-3].txt | paste -sd ' ')" "1 2 3 0"
expect "file of a job with --output=log-%a.txt" "$(echo log-*)" "log-4294967294.txt"
finish

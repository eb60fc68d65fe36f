#!/usr/bin/env bash
# 64 variations through a real Slurm (tests/slurm_cluster.sh) while everything goes wrong: the same job is handed over
# twice at once, a task's process and a whole task are killed, a node is lost half-way, the controller is started anew.
# The result must be complete, the same bytes as those of `run`, and each stage made once but for what was killed while
# it ran. Prints the table of batch jobs. Exit code 77, a skipped test, if there is no Slurm, or no root to start it.
# Usage: tests/slurm_test.sh SOURCE_FOLDER PROGRAM [VARIATIONS]
set -euo pipefail
source=$(realpath "${1:?usage: slurm_test.sh SOURCE_FOLDER PROGRAM [VARIATIONS]}")
program=$(realpath "${2:?usage: slurm_test.sh SOURCE_FOLDER PROGRAM [VARIATIONS]}")
count=${3:-64}
for tool in slurmctld slurmd munged sbatch; do
  command -v $tool >/dev/null || { echo "skipped: there is no $tool (apt-get install munge slurm-wlm)"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skipped: only root can start Slurm's daemons"; exit 77; }

scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-slurm.XXXXXX")
cluster=("$source/tests/slurm_cluster.sh")
trap '"${cluster[@]}" stop "$scratch/slurm" >/dev/null 2>&1 || true; rm -rf "$scratch"' EXIT
cd "$scratch"
if ! setting=$("${cluster[@]}" start "$scratch/slurm"); then
  tail -n 5 "$scratch"/slurm/*.log >&2 || true
  echo "skipped: Slurm's daemons do not start on this machine"
  exit 77
fi
export "${setting?}"
# A path in which Slurm would find patterns, and a shell words.
export TERRAZZO_CACHE="$scratch/Stone%20Wall/%j it's/cache"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

state() {
  "$program" submit --status --json "$job" | python3 -c "import json, sys; print(json.load(sys.stdin)['counts']['$1'])"
}

# until STATE NUMBER: waits until so many units are in that state, for a minute at most.
until_state() {
  for _ in $(seq 300); do [ "$(state "$1")" -lt "$2" ] || return 0; sleep 0.2; done
  complain "there were never $2 units in state $1"
}

# kill_one PATTERN: the first process that has this in its command line.
kill_one() {
  for _ in $(seq 2000); do ! pkill -KILL -f -o -- "$1" || return 0; sleep 0.01; done
  complain "no process $1 could be killed"
}

"$program" run "$source/graphs/generate-exemplar.json" --set type=bricks --set size=256x256 --set out=bricks --progress none
cp "$source/graphs/material.json" walls.json
values=(walls.json --set material=bricks --set size=512x512 --sweep "seed=1..$count")
arguments=("${values[@]}" --set "out=='farm/' + seed" --pack 2 --cores 1 --memory 500M)

# Twice at once: one of them hands over, the other finds that done.
"$program" submit "${arguments[@]}" >first.txt &
"$program" submit "${arguments[@]}" >second.txt
wait $!
job=$(sed -n 's/^job //p' first.txt)
[ "$(sed -n 's/^job //p' second.txt)" = "$job" ] || complain "the second submission is another job"
[ "$(cat first.txt second.txt | grep -c 'handed over before')" = 1 ] || complain "it was not handed over exactly once"
cat first.txt second.txt | grep -v 'handed over before' | grep -v '^job' | sort -u
tasks=$(squeue --array --noheader --name="$job" | wc -l)
[ "$tasks" -le $((count + 1)) ] || complain "there are $tasks tasks in the queue"

"$program" submit "$job" --wait >waited.txt 2>&1 &
waiting=$!

# The process that makes a unit: it is started again. The task that looks after it: it gets lost, and is handed over
# again by --wait.
until_state done 3
kill_one "task --in-process"
until_state done 6
kill_one "task $scratch.*--array"
until_state done $((count / 4))
echo "before the node is lost: $(state done) of $((count + 1)) units"
"${cluster[@]}" lose-node n2 "$scratch/slurm"
until_state done $((count / 3))
"${cluster[@]}" restart-controller "$scratch/slurm"
sleep 2
"${cluster[@]}" return-node n2 "$scratch/slurm"
wait $waiting || { complain "waiting failed"; cat waited.txt >&2; "$program" submit --status "$job" >&2; }
cat waited.txt | tail -5

# Complete and right.
"$program" run "${values[@]}" --set "out=='here/' + seed" --no-cache --progress none
[ "$(find farm -type f | wc -l)" = "$(find here -type f | wc -l)" ] || complain "files are missing"
diff -r farm here >/dev/null || complain "a farm's bytes are not those of one process"

# Each analysis once.
logs=$TERRAZZO_CACHE/farm/jobs/$job/logs
for stage in index space lattice weighted guides; do
  made=$(cat "$logs"/*.log | grep -cE "\] $stage \([a-z_]+\) [0-9.]+ s" || true)
  [ "$made" = 1 ] || complain "$stage was made $made times"
done
layouts=$(cat "$logs"/*.log | grep -cE '\] layout_seed_[0-9]+ \(synthesize\) [0-9.]+ s' || true)
echo "$layouts syntheses for $count variations"
[ "$layouts" -le $((count + 6)) ] || complain "too many were made again"
grep -q 'starting it again' "$logs"/*.log || complain "no log says that a process was started again"

# Again: nothing to do. Something else: only that.
[ "$("$program" submit "${arguments[@]}")" = "nothing to do: all of it has been made" ] || complain "it would be made again"
"$program" submit walls.json --set material=bricks --set size=512x512 --set seed=$((count + 1)) --set out=more --wait \
  >more.txt 2>&1 || complain "one more failed"
! grep -q ' index ' more.txt || complain "the analysis was handed over again"

# A unit that fails says why, the others are made; an input that is gone after the submission is not missed.
"$program" submit walls.json --set material=bricks --set seed=900 --sweep size=64x64,96x96 --set "out=='sized/' + size.x" \
  --pack 0 >sized.txt
rm -r bricks
mkdir -p sized && touch sized/64
job=$(sed -n 's/^job //p' sized.txt)
code=0
"$program" submit --wait "$job" >sized-waited.txt 2>&1 || code=$?
[ $code = 1 ] || complain "a failed unit gave exit code $code"
grep -q 'failed.*sized/64' sized-waited.txt || { complain "it does not say why"; cat sized-waited.txt >&2; }
[ -s sized/96/height.png ] || complain "the other unit was not made"

# The commands of the guide that need Slurm.
mkdir -p tree/bin
cp -r "$source/graphs" tree
ln -s "$program" tree/bin/terrazzo
awk '/^```bash/ { open = 1; next } /^```/ { open = 0 } open' "$source/examples/guide/automation.md" >tree/commands.sh
grep -q 'submit' tree/commands.sh || complain "the guide has no commands to run"
(cd tree && PATH=$PWD/bin:$PATH bash -euo pipefail commands.sh) >guide.txt 2>&1 || { complain "the guide's commands fail"; cat guide.txt >&2; }
[ -s tree/out/farm/walls/8/height.png ] || complain "the guide's commands make no walls"

# With --keep-going, what needs an exemplar that cannot be read is left out, and all else is made.
cp -r tree/out/farm/bricks sound
cp -r sound cut
truncate --size=-100 cut/height.png
printf 'material,out\nsound,going/sound\ncut,going/cut\n' >going.csv
code=0
"$program" submit walls.json --set size=64x64 --table going.csv --keep-going --wait >going.txt 2>&1 || code=$?
[ $code = 1 ] || complain "something was left out, with exit code $code"
grep -q 'left out.*cut/height.png: it is truncated' going.txt || { complain "it is not said what was left out"; cat going.txt >&2; }
[ -s going/sound/height.png ] && [ ! -e going/cut ] || complain "the sound variation was not made, or the other one was"

# What users have set for their own calls of Slurm's tools hides no task, beats no option, and keeps no task in the queue.
hostile=(SQUEUE_STATES=RUNNING SQUEUE_USERS=nobody SQUEUE_PARTITION=none SQUEUE_NAMES=none SQUEUE_FORMAT=%i SQUEUE_QOS=none
  SQUEUE_ACCOUNT=none SBATCH_JOB_NAME=other SBATCH_ARRAY_INX=5-6 SBATCH_NO_REQUEUE=1 SBATCH_MEM_PER_NODE=1 SBATCH_WAIT=1
  SBATCH_OUTPUT=/nowhere/x SBATCH_ERROR=/nowhere/y SBATCH_PARTITION=none SBATCH_TIMELIMIT=0:01 SBATCH_EXPORT=NONE
  SBATCH_RESERVATION=none SBATCH_CONSTRAINT=none SBATCH_DEBUG=1 SBATCH_CLUSTERS=other SBATCH_OPEN_MODE=truncate SBATCH_QOS=none
  SLURM_CLUSTERS=other SLURM_EXIT_ERROR=9 SLURM_BITSTR_LEN=1 SLURM_NTASKS=7 SLURM_MEM_PER_CPU=1 SLURM_UMASK=0777
  SLURM_DEBUG_FLAGS=Protocol SLURM_HOSTFILE=/nowhere SLURM_CPUS_PER_TASK=64 SLURM_WORKING_CLUSTER=other:nowhere:1:2
  SCANCEL_STATE=SUSPENDED SCANCEL_USER=nobody SCANCEL_NAME=none SCANCEL_PARTITION=none SCANCEL_INTERACTIVE=yes SCANCEL_QOS=none
  SCONTROL_ALL=0 SCONTROL_FEDERATION=1 SCONTROL_SIB=1 SINFO_PARTITION=none SINFO_FORMAT=%n SINFO_FEDERATION=1
  SACCT_FORMAT=none SACCT_FEDERATION=1 SALLOC_PARTITION=none SRUN_DEBUG=9)
"$program" run "$source/graphs/generate-exemplar.json" --set type=bricks --set size=128x128 --set out=bricks --progress none
env "${hostile[@]}" "$program" submit walls.json --set material=bricks --set size=96x96 --sweep seed=1..3 \
  --set "out=='hostile/' + seed" --pack 0 --wait >hostile.txt 2>&1 || { complain "settings of the user break it"; cat hostile.txt >&2; }
[ "$(find hostile -name height.png | wc -l)" = 3 ] || complain "settings of the user change what is made"
! grep -q 'got lost' hostile.txt || complain "settings of the user hide tasks"
grep -q 'SBATCH_WAIT.*ignored; ask with' hostile.txt || complain "it is not said which settings are ignored"
logs=$TERRAZZO_CACHE/farm/jobs/$(sed -n 's/^job //p' hostile.txt)/logs
[ "$(find "$logs" -name '*_*.log' | wc -l)" -ge 3 ] || complain "a task has no log of its own"

# A single setting that takes effect would be enough: each by itself, cancelled while all tasks wait.
scontrol update PartitionName=main State=DOWN
"$program" submit walls.json --set material=bricks --set size=80x80 --sweep seed=1..3 --set "out=='kept/' + seed" --pack 0 >kept.txt
job=$(sed -n 's/^job //p' kept.txt)
queued=$(squeue --all --array --noheader --name="$job" | wc -l)
[ "$queued" -ge 3 ] || complain "only $queued tasks are in the queue"
for setting in "${hostile[@]}"; do
  [ "$(env "$setting" "$program" submit --status --json "$job" |
    python3 -c "import json, sys; print(json.load(sys.stdin)['counts']['waiting'])")" = "$queued" ] || complain "$setting hides tasks"
done
for setting in "${hostile[@]}"; do
  case $setting in SCANCEL_* | SQUEUE_* | SLURM_*) ;; *) continue ;; esac
  "$program" submit walls.json --set material=bricks --set size=80x80 --sweep seed=1..3 --set "out=='kept/' + seed" --pack 0 \
    >again.txt 2>&1 || { complain "submitting again fails"; cat again.txt >&2; }
  env "$setting" "$program" submit "$job" --cancel >cancelled.txt 2>&1 || { complain "$setting breaks --cancel"; cat cancelled.txt >&2; }
  [ -z "$(squeue --all --noheader --states=PENDING,RUNNING --name="$job")" ] || complain "$setting keeps tasks in the queue"
done

# Tasks that stay in the queue, as another user's do: cancelling says so.
"$program" submit walls.json --set material=bricks --set size=80x80 --sweep seed=1..3 --set "out=='kept/' + seed" --pack 0 >again.txt
mkdir -p deaf
printf '#!/bin/sh\nexit 0\n' >deaf/scancel && chmod +x deaf/scancel
! PATH=$PWD/deaf:$PATH "$program" submit "$job" --cancel >cancelled.txt 2>&1 || complain "it says that it cancelled what is still there"
grep -q "$queued tasks of .* are still in the queue" cancelled.txt || { complain "it does not say what is still there"; cat cancelled.txt >&2; }
"$program" submit "$job" --cancel >/dev/null
scontrol update PartitionName=main State=UP

# Snakemake makes a job by its stamps.
if command -v snakemake >/dev/null; then
  cp -r tree/out/farm/bricks .
  "$program" submit walls.json --set material=bricks --set size=128x128 --sweep seed=1..3 --set "out=='snake/' + seed" \
    --openjd snake.json
  job=$(python3 -c 'import json; print(json.load(open("snake.json"))["name"])')
  snakemake --quiet --snakefile "$source/examples/farm/Snakefile" --config job="$job" program="$program" --cores 2 \
    >snake.txt 2>&1 || { complain "snakemake failed"; cat snake.txt >&2; }
  [ "$(find snake stamps -name 'height.png' -o -name '*.json' | wc -l)" = 7 ] || complain "snakemake made something else"
else
  echo "skipped: snakemake (apt-get install snakemake)"
fi

echo "batch jobs:"
scontrol --oneliner show job | grep -oE '^JobId=[0-9]+|ArrayJobId=[0-9]+|JobState=[A-Z_]+|Restarts=[1-9][0-9]*' | paste -sd' ' |
  sed 's/ JobId=/\nJobId=/g' | grep -oE 'ArrayJobId=[0-9]+.*' | sort | uniq -c | sort -rn | head -12
exit $failed

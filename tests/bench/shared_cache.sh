#!/usr/bin/env bash
# Processes that start at once on one cold cache, and ask for the same with folders of their own to write to: wall and
# CPU seconds of all together, and how often each stage was computed.
# Usage: tests/bench/shared_cache.sh PROGRAM [COUNT]...
set -euo pipefail
program=$(realpath "${1:?usage: shared_cache.sh PROGRAM [COUNT]...}")
shift
counts=("${@:-1}")
[ $# -gt 0 ] || counts=(1 8)
graphs=$(realpath "$(dirname "$0")/../../graphs")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-shared.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$program" run "$graphs/generate-exemplar.json" --set type=bricks --set size=256x256 --set out=bricks --no-cache --progress none
TIMEFORMAT='%R s, CPU %U + %S s'
for count in "${counts[@]}"; do
  rm -rf cache out ./*.log
  time {
    for i in $(seq "$count"); do
      "$program" run "$graphs/material.json" --set material=bricks --set size=512x512 --set "out=out/$i" \
        --cache cache --progress plain 2>"$i.log" >/dev/null &
    done
    wait
  }
  sed -nE 's/^\[.*\] (\w+) \(\w+\) [0-9.]+ s$/\1/p' ./*.log | sort | uniq -c | sort -rn | awk '{ print "  " $1, $2 }'
done

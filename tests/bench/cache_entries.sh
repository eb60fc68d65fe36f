#!/usr/bin/env bash
# What a run that has nothing to do costs beside many cache entries: fills a cache folder with COUNT entries that no run
# asks for, and prints how long the second of two equal runs takes, and how many entries it looks at (by strace, if it
# is installed: system calls of the kind stat).
# Usage: tests/bench/cache_entries.sh PROGRAM [COUNT]...
set -euo pipefail
program=$(realpath "${1:?usage: cache_entries.sh PROGRAM [COUNT]...}")
shift
counts=("${@:-10}")
[ $# -gt 0 ] || counts=(10 1000 100000)
graphs=$(realpath "$(dirname "$0")/../../graphs")
for count in "${counts[@]}"; do
  scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-entries.XXXXXX")
  python3 - "$scratch/cache/v1" "$count" <<'PYTHON'
import hashlib, os, sys
root, count = sys.argv[1], int(sys.argv[2])
for i in range(count):
    name = hashlib.md5(str(i).encode()).hexdigest()
    kind = ("values", "stages", "files")[i % 3]
    os.makedirs(f"{root}/{kind}/{name[:2]}", exist_ok=True)
    with open(f"{root}/{kind}/{name[:2]}/{name}{'.tzv' if kind == 'values' else ''}", "wb") as f:
        f.write(b"x" * 200)
PYTHON
  run=("$program" run "$graphs/generate-exemplar.json" --set type=tiles --set size=64x64 --set "out=$scratch/out"
       --cache "$scratch/cache" --progress none)
  "${run[@]}"
  "${run[@]}"
  seconds=()
  for _ in 1 2 3 4 5; do
    begin=$(date +%s%N)
    "${run[@]}"
    seconds+=("$((($(date +%s%N) - begin) / 1000000))")
  done
  median=$(printf '%s\n' "${seconds[@]}" | sort -n | sed -n 3p)
  calls=
  ! command -v strace >/dev/null || calls=$(strace -f -e trace=stat,lstat,newfstatat,statx "${run[@]}" 2>&1 | grep -c stat || true)
  echo "$count entries: $median ms${calls:+, $calls calls of stat}"
  rm -rf "$scratch"
done

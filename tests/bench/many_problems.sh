#!/usr/bin/env bash
# How long `check` takes on graphs of COUNT nodes that are all wrong, and how much it prints: it must be linear.
# Usage: tests/bench/many_problems.sh PROGRAM [COUNT]...
set -euo pipefail
program=$(realpath "${1:?usage: many_problems.sh PROGRAM [COUNT]...}")
shift
counts=("$@")
[ $# -gt 0 ] || counts=(10000 99999)
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-problems.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
for count in "${counts[@]}"; do
  python3 - "$scratch" "$count" <<'PYTHON'
import json, sys
folder, n = sys.argv[1], int(sys.argv[2])
kinds = {
    "parameters": lambda i: {"type": "blur", "image": "@g", "radius": "wrong"},
    "types": lambda i: {"type": "resolve_uv", "uv": "@g", "material": "@g"},
    "nowhere": lambda i: {"type": "blur", "image": f"@m{i}"},
    "cycle": lambda i: {"type": "blur", "image": f"@n{(i + 1) % n}"},
    "cycles": lambda i: {"type": "blend", "base": f"@n{i + 1}" if i < n - 1 else "@g", "top": "@n0"},
}
for kind, node in kinds.items():
    nodes = {"g": {"type": "solid", "value": 0.5, "size": [8, 8]}} | {f"n{i}": node(i) for i in range(n)}
    with open(f"{folder}/{kind}.json", "w") as f:
        json.dump({"terrazzo": 1, "nodes": nodes}, f, indent=0)
PYTHON
  for kind in parameters types nowhere cycle cycles; do
    begin=$(date +%s%N)
    "$program" check "$scratch/$kind.json" >"$scratch/said" 2>&1 || true
    echo "$count nodes, $kind: $((($(date +%s%N) - begin) / 1000000)) ms, $(wc -c <"$scratch/said") bytes"
  done
done

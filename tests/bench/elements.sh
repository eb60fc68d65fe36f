#!/usr/bin/env bash
# Whole elements: for each exemplar, twice its size, with and without laying its elements: the share of hybrids by area
# and by number, and what else changes. The table goes into experiments.md#element_layout. Uses the build folder.
# Usage: tests/bench/elements.sh OUT FOLDER_OF_MAPS...
# SEEDS="1 2 3": one run for each. OUT/NAME/SEED-with and -without hold the results to look at.
set -euo pipefail
[ $# -gt 1 ] && [ -d "$2" ] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
out=$(realpath -m "$1")
shift
folders=()
for folder; do folders+=("$(realpath "$folder")"); done
cd "$(dirname "$0")/../.."
export TERRAZZO_CACHE=$out/cache
echo "| exemplar | seed | certainty | | hybrids | by number | broken | structure | swd | coherence | complete | s |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
for folder in "${folders[@]}"; do
  name=$(basename "$folder")
  for seed in ${SEEDS:-1}; do
    for whole in false true; do
      to=$out/$name/$seed-$([ $whole = true ] && echo with || echo without)
      mkdir -p "$to"
      build/terrazzo run tests/bench/elements.json --progress plain --set "material=$folder" --set seed=$seed \
        --set whole=$whole --set "out=$to" --force 2>"$to/log.txt"
      python3 - "$name" "$seed" "$to" <<'P'
import json, re, sys
name, seed, to = sys.argv[1:]
figures = {f["name"]: f["value"] for f in json.load(open(f"{to}/report.json"))["figures"]}
log = open(f"{to}/log.txt").read()
sure = re.search(r'"elements": .*certainty ([0-9.]+)', log)
took = re.search(r"layout \(synthesize\) ([0-9.]+) s", log)
cells = [name, seed, sure.group(1) if sure else "none", to.rsplit("-", 1)[1]]
cells += [f"{figures[k]:.3f}" if k in figures else "-"
          for k in ("hybrids", "hybrids_by_number", "broken", "structure", "swd", "coherence", "completeness")]
print("| " + " | ".join(cells + [took.group(1) if took else "cached"]) + " |")
P
    done
  done
done

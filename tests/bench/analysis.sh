#!/usr/bin/env bash
# Growth of the analysis with the exemplar and the number of maps, and whether synthesis depends on that number: CPU time
# of each stage of graphs/material.json on generated gravel. The table goes into performance.md.
# Needs a build (cmake --preset release).
# Usage: tests/bench/analysis.sh [REPEATS]   (3 if not given; the least of them counts; some minutes)
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,5s/^# //p' "$0"; exit; }
cd "$(dirname "$0")/../.."
repeats=${1:-3}
program=${TERRAZZO:-build/terrazzo}
out=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-analysis.XXXXXX")
trap 'rm -rf "$out"' EXIT

# material SIDE MAPS: prints the folder of such an exemplar.
material() {
  local folder=$out/$1-$2
  "$program" run graphs/generate-exemplar.json --progress none --set type=gravel --set "size=$1x$1" --set "out=$folder" \
    --no-cache 2>/dev/null
  rm "$folder/preview.png"
  [ "$2" != 1 ] || find "$folder" -type f ! -name base_color.png -delete
  echo "$folder"
}

# seconds FOLDER NODE OPTION...: prints the CPU seconds of a run up to a node.
seconds() {
  "$program" run graphs/material.json --set "material=$1" --set size=2048x2048 --only "$2" --progress json "${@:3}" 2>&1 |
    sed -nE 's/.*"event":"finished".*"cpu_seconds":([^,]*),.*/\1/p'
}
least() { for ((i = 0; i < repeats; i++)); do seconds "$@"; done | sort -g | head -1; }

# row SIDE MAPS NODE...: CPU nanoseconds per exemplar pixel of each node but the first, and their sum. A node's time is the
# difference of a run up to it and a run up to the node before.
row() {
  local side=$1 maps=$2 folder times=()
  folder=$(material "$side" "$maps")
  for node in "${@:3}"; do times+=("$(least "$folder" "$node" --no-cache)"); done
  echo "${times[@]}" | awk -v side="$side" -v maps="$maps" '{
    printf "| %d, %d |", side, maps
    for (i = 2; i <= NF; i++) printf " %.0f |", ($i - $(i - 1)) * 1e9 / side / side
    printf " %.0f |\n", ($NF - $1) * 1e9 / side / side
  }'
}

echo "| side, maps | weights, wrap detection | lattice | edges, components | candidates | sum |"
echo "|---|---|---|---|---|---|"
for case in "256 1" "512 1" "512 5" "1024 1" "2048 1" "2048 5" "256 5"; do
  # shellcheck disable=SC2086
  row $case exemplar weighted lattice space index | tee -a "$out/table"
done
for maps in 1 5; do
  folder=$(material 512 "$maps")
  "$program" run graphs/material.json --set "material=$folder" --only index --cache "$out/cache" --progress none >/dev/null 2>&1
  for ((i = 1; i <= repeats; i++)); do
    echo "$maps $(seconds "$folder" layout --cache "$out/cache" --set "seed=$i")"
  done
done >"$out/synthesis"

awk -F'[|, ]+' '{ sum[$2, $3] = $8; similar[$2, $3] = $7 } END {
  for (maps = 1; maps <= 5; maps += 4)
    printf "a pixel of 2048x2048 against one of 256x256, maps %d: %.2f\n", maps, sum[2048, maps] / sum[256, maps]
  printf "five maps against one, 512x512: %.2f; candidates alone: %.2f\n", sum[512, 5] / sum[512, 1], similar[512, 5] / similar[512, 1]
}' "$out/table"
awk '{ took[$1] += $2 } END {
  printf "synthesis of 2048x2048 from a cached index of those, five maps against one: %.2f\n", took[5] / took[1]
}' "$out/synthesis"

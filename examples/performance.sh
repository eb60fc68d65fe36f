#!/usr/bin/env bash
# Measures time and memory of analysis and synthesis against the exemplar's resolution, the number of maps and the
# output's resolution. Writes a CSV table and an SVG plot of each to out/performance/.
# Usage: examples/performance.sh [quick|normal|large]      (seconds, minutes, half an hour; needs a build)
# Your own settings: EXEMPLARS="256 512" OUTPUTS="512 1024" MAPS="1 3 5" REPEATS=3 examples/performance.sh
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-normal}" in
  quick) exemplars="64 128 256" outputs="128 256 512" repeats=1 ;;
  normal) exemplars="128 256 512 1024" outputs="256 512 1024 2048" repeats=3 ;;
  large) exemplars="128 256 512 1024 2048" outputs="256 512 1024 2048 4096" repeats=5 ;;
  *) sed -n '2,5s/^# //p' "$0"; exit 2 ;;
esac
exemplars=${EXEMPLARS:-$exemplars} outputs=${OUTPUTS:-$outputs} maps=${MAPS:-1 2 3 4 5} repeats=${REPEATS:-$repeats}
[ -x build/terrazzo ] || { echo "there is no build/terrazzo; run examples/quickstart.sh first" >&2; exit 2; }
names=(base_color height normal roughness ambient_occlusion)
usual_exemplar=256 usual_output=512
out=$PWD/out/performance
rm -rf "$out"
mkdir -p "$out"

# material SIDE COUNT: prints the folder of an exemplar with SIDE pixels per side and COUNT maps.
material() {
  local all=$out/exemplars/$1-all folder=$out/exemplars/$1-$2
  [ -d "$all" ] || build/terrazzo run graphs/generate-exemplar.json --set type=gravel --set "size=$1" \
    --set "out=$all" --no-cache --progress none 2>"$out/said" || { cat "$out/said" >&2; exit 1; }
  mkdir -p "$folder"
  for name in "${names[@]:0:$2}"; do cp "$all/$name.png" "$folder"; done
  echo "$folder"
}

# measured ARGUMENT...: prints CPU seconds (the least of the repeats) and peak MiB of a run with these arguments.
measured() {
  for ((i = 0; i < repeats; i++)); do
    build/terrazzo run graphs/material.json --progress json --set "out=$out/files" "$@" --set "seed=$((first_seed + i))" 2>&1 |
      grep '"event":"finished"'
  done | sed -E 's/.*"cpu_seconds":([^,]*),"peak_memory":([^,]*),.*/\1 \2/' |
    awk 'NR == 1 || $1 < cpu { cpu = $1 } $2 > peak { peak = $2 } END { printf "%.3f,%.1f", cpu, peak / 1048576 }'
}

# row PLOT X ARGUMENT...: adds a row. Each row has its own seeds, so that no layout comes from the cache.
first_seed=1
row() {
  local line
  first_seed=$((first_seed + repeats))
  line="$2,$(measured "${@:3}")"
  echo "$line" >>"$out/$1.csv"
  echo "$1: $line"
}

# synthesis PLOT X FOLDER OUTPUT: adds a row for synthesis alone; the analysis comes from a cache.
synthesis() {
  measured --set "material=$3" --only index --cache "$out/cache" >/dev/null
  row "$1" "$2" --set "material=$3" --set "size=$4" --only layout --cache "$out/cache"
}

for n in $exemplars; do
  row analysis-exemplar "$n" --set "material=$(material "$n" 5)" --only index --no-cache
  synthesis synthesis-exemplar "$n" "$(material "$n" 5)" $usual_output
done
for n in $maps; do
  row analysis-maps "$n" --set "material=$(material $usual_exemplar "$n")" --only index --no-cache
  synthesis synthesis-maps "$n" "$(material $usual_exemplar "$n")" $usual_output
done
for n in $outputs; do synthesis synthesis-output "$n" "$(material $usual_exemplar 5)" "$n"; done

# plot NAME TITLE LABEL log|linear: draws a table.
plot() {
  awk -v title="$2" -v label="$3" -v scale="$4" -f examples/performance/plot.awk "$out/$1.csv" >"$out/$1.svg"
  sed -i '1ix,cpu_seconds,peak_MiB' "$out/$1.csv"
}
plot analysis-exemplar "Analysis of five maps" "exemplar, pixels a side" log
plot analysis-maps "Analysis of ${usual_exemplar}x${usual_exemplar} pixels" "maps" linear
plot synthesis-exemplar "Synthesis of ${usual_output}x${usual_output} pixels" "exemplar, pixels a side" log
plot synthesis-maps "Synthesis of ${usual_output}x${usual_output} pixels" "maps" linear
plot synthesis-output "Synthesis from ${usual_exemplar}x${usual_exemplar} pixels" "output, pixels a side" log
rm -rf "$out/cache" "$out/files" "$out/exemplars" "$out/said"
echo
echo "The plots:"
ls "$out"/*.svg

#!/usr/bin/env bash
# Whole runs of a five-map material at growing sizes, the analysis cached: seconds, CPU time per output pixel, peak memory.
# Needs a build (cmake --preset release) and GNU time. The table goes into scale.md.
# Usage: tests/bench/scale.sh [FOLDER_OF_MAPS [SIZE...]]
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,4s/^# //p' "$0"; exit; }
[ -z "${1:-}" ] || [ -d "$1" ] || { echo "$1: expected a folder with the maps of one material" >&2; exit 2; }
material=${1:+$(realpath "$1")}
shift || true
cd "$(dirname "$0")/../.."
command -v /usr/bin/time >/dev/null || { echo "there is no /usr/bin/time; install GNU time" >&2; exit 2; }
program=${TERRAZZO:-build/terrazzo}
out=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-scale.XXXXXX")
trap 'rm -rf "$out"' EXIT
export TERRAZZO_CACHE=$out/cache

if [ -z "$material" ]; then
  material=$out/exemplar
  "$program" run graphs/generate-exemplar.json --progress none --set type=bricks --set size=1024x1024 --set "out=$material" 2>/dev/null
fi
"$program" run graphs/material.json --progress none --set "material=$material" --only index 2>/dev/null

echo "| size | seconds | CPU seconds | CPU µs per pixel | peak MiB |"
echo "|---|---|---|---|---|"
[ $# != 0 ] || set -- 1024 2048 4096 8192
for size; do
  /usr/bin/time -o "$out/time" -f "%e %U %S %M" "$program" run graphs/material.json --progress none \
    --set "material=$material" --set "size=${size}x$size" --set "out=$out/maps" 2>/dev/null
  read -r wall user system peak < <(tail -1 "$out/time")
  awk -v n="$size" -v w="$wall" -v u="$user" -v s="$system" -v p="$peak" \
    'BEGIN { printf "| %d | %.1f | %.1f | %.2f | %d |\n", n, w, u + s, (u + s) * 1e6 / n / n, p / 1024 }'
done

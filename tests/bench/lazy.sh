#!/usr/bin/env bash
# Time and memory of computing the last of many images that are made one from the other: chains of blurs and of
# curves, blends of a node with itself, thousands of readers of one node, curves fitted to the image before them.
# Needs a build (cmake --preset release) and GNU time. The table belongs into lazy.md.
# Usage: tests/bench/lazy.sh [SIDE [NODES...]]   (16 pixels; 10 100 1000 10000 nodes)
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,5s/^# //p' "$0"; exit; }
side=${1:-16}
shift || true
[ $# != 0 ] || set -- 10 100 1000 10000
cd "$(dirname "$0")/../.."
command -v /usr/bin/time >/dev/null || { echo "there is no /usr/bin/time; install GNU time" >&2; exit 2; }
program=${TERRAZZO:-$PWD/build/terrazzo}
folder=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-lazy.XXXXXX")
trap 'rm -rf "$folder"' EXIT

graph() {
  awk -v shape="$1" -v count="$2" -v side="$side" 'BEGIN {
    printf "{\"terrazzo\": 1, \"nodes\": {\n\"n0\": {\"type\": \"noise\", \"size\": %d}", side
    for (i = 1; i <= count; i++) {
      last = i - 1; before = i > 2 ? i - 2 : 0
      printf ",\n\"n%d\": ", i
      if (shape == "blurs") printf "{\"type\": \"blur\", \"image\": \"@n%d\", \"radius\": 2}", last
      if (shape == "curves") printf "{\"type\": \"levels\", \"image\": \"@n%d\", \"gamma\": 1.01}", last
      if (shape == "diamonds") printf "{\"type\": \"blend\", \"base\": \"@n%d\", \"top\": \"@n%d\", \"opacity\": 0.5}", last, last
      if (shape == "fitted") printf "{\"type\": \"levels\", \"image\": \"@n%d\", \"auto\": \"image\"}", last
      if (shape == "readers" && i % 2) printf "{\"type\": \"levels\", \"image\": \"@n0\", \"in_black\": %.6f}", i / count / 2
      if (shape == "readers" && i % 2 == 0) printf "{\"type\": \"blend\", \"base\": \"@n%d\", \"top\": \"@n%d\", \"opacity\": 0.5}", last, before
    }
    printf ",\n\"file\": {\"type\": \"export\", \"material\": \"@n%d\", \"path\": \"out.png\"}}}\n", count
  }'
}

echo "| images | nodes | seconds | CPU seconds | peak MiB |"
echo "|---|---|---|---|---|"
for shape in blurs curves diamonds readers fitted; do
  for count; do
    graph "$shape" "$count" >"$folder/graph.json"
    /usr/bin/time -o "$folder/time" -f "%e %U %S %M" "$program" run "$folder/graph.json" --no-cache --progress none 2>/dev/null
    read -r wall user system peak < <(tail -1 "$folder/time")
    awk -v shape="$shape" -v n="$count" -v w="$wall" -v u="$user" -v s="$system" -v p="$peak" \
      'BEGIN { printf "| %s | %d | %.2f | %.2f | %d |\n", shape, n, w, u + s, p / 1024 }'
  done
done

#!/usr/bin/env bash
# What should feel immediate: start-up, a run with everything cached, a draft. Wall and CPU seconds, the least of five.
# Needs a build (cmake --preset release) and GNU time. Wall seconds are meaningful on an idle machine only.
# Usage: tests/bench/interactive.sh [PICTURE]   (generated gravel of 256x256 if not given)
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,4s/^# //p' "$0"; exit; }
picture=${1:+$(realpath "$1")}
cd "$(dirname "$0")/../.."
program=${TERRAZZO:-build/terrazzo}
out=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-interactive.XXXXXX")
trap 'rm -rf "$out"' EXIT

# timed WHAT COMMAND...: times the command, with `seed` appended, in which SEED becomes another number each time.
timed() {
  for i in 1 2 3 4 5; do
    /usr/bin/time -o "$out/time" -f "%e %U %S" "${@:2}" "${seed[@]/SEED/$i}" >/dev/null 2>&1
    tail -1 "$out/time"
  done | awk -v what="$1" '{ cpu = $2 + $3 } NR == 1 || $1 < wall { wall = $1 } NR == 1 || cpu < least { least = cpu }
    END { printf "| %s | %.2f | %.2f |\n", what, wall, least }'
}

"$program" run graphs/generate-exemplar.json --set type=gravel --set size=256x256 --set "out=$out/exemplar" --no-cache \
  >/dev/null 2>&1
rm "$out/exemplar/preview.png"
picture=${picture:-$out/exemplar/base_color.png}
material=(run graphs/material.json --set "material=$out/exemplar" --set size=1024x1024 --set "out=$out/material")
draft=(run graphs/texture.json --set "image=$picture" --set quality=draft --set size=512x512 --set "out=$out/draft")

echo "| | wall s | CPU s |"
echo "|---|---|---|"
seed=()
timed "terrazzo --version" "$program" --version
"$program" "${material[@]}" --cache "$out/cache" >/dev/null 2>&1
timed "graphs/material.json, five maps of 1024x1024, all cached" "$program" "${material[@]}" --cache "$out/cache"
timed "draft of 512x512, nothing cached" "$program" "${draft[@]}" --no-cache
"$program" "${draft[@]}" --cache "$out/cache" >/dev/null 2>&1
seed=(--set seed=1SEED)
timed "draft of 512x512, analysis cached" "$program" "${draft[@]}" --cache "$out/cache"

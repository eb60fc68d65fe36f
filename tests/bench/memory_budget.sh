#!/usr/bin/env bash
# Peak memory of whole runs with --memory on an empty cache, against 1.2 times the budget plus 50 MiB. Materials of five
# maps as PNG, EXR, TIFF and JPEG; graphs that convert files, scale one map, and synthesize 512x512 in quality draft.
# Needs a build (cmake --preset release) and GNU time. The table goes into experiments.md.
# Usage: tests/bench/memory_budget.sh [FOLDER]   where the materials are made, and found again; else a temporary one
# SIZES="2048 4096" FORMATS="png exr tif jpg" BUDGETS="64M 256M 1G none" GRAPHS="convert levels synth": less of it.
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,6s/^# //p' "$0"; exit; }
materials=${1:+$(mkdir -p "$1" && realpath "$1")}
cd "$(dirname "$0")/../.."
command -v /usr/bin/time >/dev/null || { echo "there is no /usr/bin/time; install GNU time" >&2; exit 2; }
program=$(realpath "${TERRAZZO:-build/terrazzo}")
work=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-memory.XXXXXX")
trap 'rm -rf "$work"' EXIT
materials=${materials:-$work}

cat >"$work/surface.json" <<'JSON'
{"terrazzo": 1, "parameters": {"size": {"type": "size"}, "out": {"type": "path"}}, "nodes": {
  "surface": {"type": "pattern", "kind": "bricks", "size": "$size"},
  "files":   {"type": "export", "material": "@surface", "path": "$out/{map}.png"}}}
JSON
cat >"$work/convert.json" <<'JSON'
{"terrazzo": 1, "parameters": {"material": {"type": "path"}, "format": {"type": "text"}, "out": {"type": "path"}}, "nodes": {
  "maps":  {"type": "load_material", "path": "$material"},
  "files": {"type": "export", "material": "@maps", "path": "$out/{map}.$format"}}}
JSON
cat >"$work/levels.json" <<'JSON'
{"terrazzo": 1, "parameters": {"material": {"type": "path"}, "format": {"type": "text"}, "out": {"type": "path"}}, "nodes": {
  "map":     {"type": "load_map", "path": "$material/base_color.$format"},
  "lighter": {"type": "levels", "image": "@map", "gamma": 1.2},
  "smaller": {"type": "resize", "material": "@lighter", "size": 512},
  "files":   {"type": "export", "material": "@smaller", "path": "$out/{map}.png"}}}
JSON

# measured OUT BUDGET ARGUMENTS...: seconds and peak KiB, or why it did not run.
measured() {
  local out=$1 budget=$2
  shift 2
  rm -rf "$work/cache" "$out"
  [ "$budget" = none ] || set -- "$@" --memory "$budget"
  if /usr/bin/time -o "$work/time" -f "%e %M" "$program" run "$@" --set "out=$out" --cache "$work/cache" \
      --progress none >/dev/null 2>"$work/said"; then
    tail -1 "$work/time"
  else
    echo "refused $(tail -1 "$work/time" | cut -d' ' -f2) $(grep -o 'takes [^;,]*' "$work/said" | head -1)"
  fi
}
bytes_of() { numfmt --from=iec "$1"; }

echo "| size | files | graph | budget | seconds | peak MiB | goal MiB | |"
echo "|---|---|---|---|---|---|---|---|"
for size in ${SIZES:-2048 4096}; do
  source=$materials/$size-png
  [ -d "$source" ] || measured "$source" none "$work/surface.json" --set "size=${size}x$size" >/dev/null
  for format in ${FORMATS:-png exr tif jpg}; do
    material=$materials/$size-$format
    [ -d "$material" ] ||
      measured "$material" none "$work/convert.json" --set "material=$source" --set "format=$format" >/dev/null
    for graph in ${GRAPHS:-convert levels synth}; do
      for budget in ${BUDGETS:-64M 256M 1G none}; do
        if [ "$graph" = synth ]; then
          set -- graphs/material.json --set size=512x512 --set quality=draft --set "material=$material"
        else
          set -- "$work/$graph.json" --set "material=$material" --set "format=$format"
        fi
        read -r seconds peak why < <(measured "$work/out" "$budget" "$@")
        if [ "$budget" = none ]; then
          goal=- verdict=
        else
          goal=$(($(bytes_of "$budget") * 12 / 10 / 1048576 + 50))
          verdict=$([ $((peak / 1024)) -le "$goal" ] && echo kept || echo over)
        fi
        echo "| $size | $format | $graph | $budget | $seconds | $((peak / 1024)) | $goal | $verdict ${why:-}|"
      done
    done
  done
done

#!/usr/bin/env bash
# Effect of `join` and `blend` of resolve_uv on height maps: for each exemplar, one layout of 1024x1024 resolved in several
# ways. The table goes into experiments.md#joined_heights, which explains the columns. Builds the bench preset.
# Usage: tests/bench/heights.sh FOLDER_OF_MAPS...
# SETTINGS="join=0 blend=8 ...": other settings of graphs/material.json.
set -euo pipefail
[ $# -gt 0 ] && [ -d "$1" ] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
folders=()
for folder; do folders+=("$(realpath "$folder")"); done
cd "$(dirname "$0")/../.."
{
  cmake --preset bench
  cmake --build --preset bench
} >&2
out=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-heights.XXXXXX")
trap 'rm -rf "$out"' EXIT
export TERRAZZO_CACHE=$out/cache

for folder in "${folders[@]}"; do
  name=$(basename "$folder")
  results=()
  for settings in ${SETTINGS:-join=0 join=0,blend=3 join=0,blend=8 join=0.03 join=0.125}; do
    build-bench/terrazzo run graphs/material.json --progress none --set "material=$folder" --set size=1024x1024 \
      --set "out=$out/$name/$settings" --set files.depth=uint16 --set 'files.maps=["height"]' \
      --set files.uv=@layout --set "files.uv_path=$out/$name/uv.png" $(sed 's/^\|,/ --set /g' <<<"$settings") 2>/dev/null
    results+=("$out/$name/$settings/height.png")
  done
  # The exemplar as it was read, whatever its file is called.
  printf '%s' '{"terrazzo": 1, "parameters": {"material": {"type": "path"}, "out": {"type": "path"}}, "nodes": {
    "exemplar": {"type": "load_material", "path": "$material"},
    "files": {"type": "export", "material": "@exemplar", "path": "$out/{map}.png", "depth": "uint16", "maps": ["height"]}}}' >"$out/exemplar.json"
  build-bench/terrazzo run "$out/exemplar.json" --progress none --set "material=$folder" --set "out=$out/$name" 2>/dev/null
  echo
  echo "| $name | seam | false | worst | rise | inside | moved | spread | at ends |"
  echo "|---|---|---|---|---|---|---|---|---|"
  build-bench/tests/bench/terrazzo_heights "$out/$name/height.png" "$out/$name/uv.png" "${results[@]}"
done

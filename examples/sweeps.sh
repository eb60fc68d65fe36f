#!/usr/bin/env bash
# Runs the sweeps of examples/sweeps (one contact sheet each) on materials of yours, or without arguments on an exemplar
# of each class of texture that the project generates itself. Needs a build (examples/quickstart.sh).
# Usage: examples/sweeps.sh [FOLDER_OF_MAPS...]
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,4s/^# //p' "$0"; exit; }
folders=()
for folder in "$@"; do
  [ -d "$folder" ] || { echo "$folder: expected a folder with the maps of one material" >&2; exit 2; }
  folders+=("$(realpath "$folder")")
done
cd "$(dirname "$0")/.."
[ -x build/terrazzo ] || { echo "there is no build/terrazzo; run examples/quickstart.sh first" >&2; exit 2; }

out=out/sweeps
export TERRAZZO_CACHE=$out/cache
failed=()

# sweep CLASS FOLDER
sweep() {
  for graph in examples/sweeps/*.json; do
    echo "$1: $(basename "$graph" .json)"
    build/terrazzo run "$graph" --progress none --set "material=$2" --set "out=$out/$1" || failed+=("$out/$1: $graph")
  done
}

if [ ${#folders[@]} -eq 0 ]; then
  for class in stochastic:gravel irregular:cobbles near-regular:bricks regular:tiles; do
    folder=$out/${class%:*}/exemplar
    build/terrazzo run graphs/generate-exemplar.json --progress none --set "type=${class#*:}" --set size=256x256 \
      --set "out=$folder"
    sweep "${class%:*}" "$folder"
  done
else
  for folder in "${folders[@]}"; do sweep "$(basename "$folder")" "$folder"; done
fi

echo
echo "The contact sheets:"
ls "$out"/*/*.png
if [ ${#failed[@]} -gt 0 ]; then
  echo "These failed, for the reasons given above:" >&2
  printf '%s\n' "${failed[@]}" >&2
  exit 1
fi

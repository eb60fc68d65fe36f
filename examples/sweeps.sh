#!/usr/bin/env bash
# Runs the sweeps of examples/sweeps, one contact sheet each, on your materials; without arguments on a generated
# exemplar of each class of texture. Needs a build (examples/quickstart.sh).
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

# sheet SWEEP FOLDER_OF_MAPS OUT [SETTING...]: runs one sweep.
sheet() {
  local sweep=$1 maps=$2 to=$3
  shift 3
  echo "  $to/$sweep.png"
  build/terrazzo run "examples/sweeps/$sweep.json" --progress none --set "material=$maps" --set "out=$to" "$@" ||
    failed+=("$to/$sweep.png")
}

# all_sheets NAME FOLDER_OF_MAPS: runs all sweeps.
all_sheets() {
  echo "$1:"
  for sweep in jitter weights guidance dimensions lights; do sheet $sweep "$2" "$out/$1"; done
  # A lattice hides most of the effect on bricks and tiles.
  for sweep in jitter weights guidance dimensions; do sheet $sweep "$2" "$out/$1/without-lattice" --set lattice=off; done
}

if [ ${#folders[@]} -eq 0 ]; then
  for class in stochastic:gravel irregular:cobbles near-regular:bricks regular:tiles; do
    folder=$out/${class%:*}/exemplar
    build/terrazzo run graphs/generate-exemplar.json --progress none --set "type=${class#*:}" --set size=256x256 \
      --set "out=$folder"
    all_sheets "${class%:*}" "$folder"
  done
else
  for folder in "${folders[@]}"; do all_sheets "$(basename "$folder")" "$folder"; done
fi

echo
echo "The contact sheets:"
find "$out" -name '*.png' -not -path '*/exemplar/*' | sort
if [ ${#failed[@]} -gt 0 ]; then
  echo "These failed; the reasons stand above:" >&2
  printf '%s\n' "${failed[@]}" >&2
  exit 1
fi

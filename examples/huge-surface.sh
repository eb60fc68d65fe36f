#!/usr/bin/env bash
# Makes a surface tile by tile, and checks that the tiles are parts of one whole, byte for byte. Needs a build
# (examples/quickstart.sh). Other machines could make the tiles: they share a cache or nothing at all, in which case
# each computes the coarse levels itself.
# Usage: examples/huge-surface.sh [FOLDER_OF_MAPS] [TILES_A_SIDE] [PIXELS_A_TILE]
set -euo pipefail
[ "${1:-}" != "--help" ] || { sed -n '2,5s/^# //p' "$0"; exit; }
[ -z "${1:-}" ] || [ -d "$1" ] || { echo "$1: expected a folder with the maps of one material" >&2; exit 2; }
material=${1:+$(realpath "$1")}
cd "$(dirname "$0")/.."
[ -x build/terrazzo ] || { echo "there is no build/terrazzo; run examples/quickstart.sh first" >&2; exit 2; }
tiles=${2:-2}
pixels=${3:-512}
for number in "$tiles" "$pixels"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || { echo "$number: expected whole numbers of tiles and pixels, such as 2 512" >&2; exit 2; }
done
out=out/huge-surface
export TERRAZZO_CACHE=$out/cache

if [ -z "$material" ]; then
  material=$out/exemplar
  build/terrazzo run graphs/generate-exemplar.json --progress none --set type=bricks --set size=256x256 --set "out=$material"
fi
side=$((tiles * pixels))

# make FOLDER SIZE X Y
make() {
  build/terrazzo run examples/huge-surface.json --progress none --set "material=$material" --set "out=$1" \
    --set "surface=${side}x$side" --set "tile=$2x$2" --set "origin=[$3, $4]"
}

for ((y = 0; y < tiles; y++)); do
  for ((x = 0; x < tiles; x++)); do
    echo "$out/tile-$x-$y"
    make "$out/tile-$x-$y" "$pixels" $((x * pixels)) $((y * pixels))
  done
done

# The same surface at once, cropped: identical pixels give identical files.
echo "$out/whole"
make "$out/whole" "$side" 0 0
for ((y = 0; y < tiles; y++)); do
  for ((x = 0; x < tiles; x++)); do
    build/terrazzo run examples/cut-out.json --progress none --set "material=$out/whole" \
      --set "out=$out/part-$x-$y" --set "x=$((x * pixels))" --set "y=$((y * pixels))" --set "size=${pixels}x$pixels"
    for map in "$out/part-$x-$y"/*; do cmp "$map" "$out/tile-$x-$y/$(basename "$map")"; done
  done
done
echo "$((tiles * tiles)) tiles of ${pixels}x$pixels pixels in $out: each equals its part of the whole, byte for byte"

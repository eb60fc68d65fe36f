#!/usr/bin/env bash
# What each lossless compression of EXR costs: all maps of a material as halfs, made larger or smaller to SIZE, in one
# file each. MB on the disk, and seconds of one core to read the uncompressed files and write these (least of three). The
# table goes into experiments.md. Needs oiiotool (openimageio-tools).
# Usage: tests/bench/exr_compression.sh FOLDER_OF_MAPS [SIZE]   2048 if not given
# TERRAZZO_PROGRAM: the program, if not build/terrazzo.
set -euo pipefail
[ $# -ge 1 ] && [ -d "$1" ] || { sed -n '2,6s/^# //p' "$0"; exit 2; }
material=$(realpath "$1")
size=${2:-2048}
program=$(realpath "${TERRAZZO_PROGRAM:-$(dirname "$0")/../../build/terrazzo}")
command -v oiiotool >/dev/null || { echo "there is no oiiotool; install openimageio-tools" >&2; exit 2; }
work=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-exr.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir plain packed
cat >halfs.json <<'JSON'
{"terrazzo": 1, "parameters": {"material": {"type": "path"}, "size": {"type": "size"}}, "nodes": {
  "maps": {"type": "load_material", "path": "$material"},
  "sized": {"type": "resize", "material": "@maps", "size": "$size"},
  "files": {"type": "export", "material": "@sized", "path": "{map}.exr", "depth": "half"}}}
JSON
"$program" run halfs.json --set material="$material" --set size="$size" --no-cache --progress none >&2
for file in *.exr; do oiiotool "$file" --compression none -o "plain/$file"; done

# seconds COMPRESSION: of one core, for all maps.
seconds() {
  local file TIMEFORMAT=%U
  { time for file in plain/*; do oiiotool --threads 1 "$file" --compression "$1" -o "packed/$(basename "$file")"; done; } 2>&1
}

echo "| $(basename "$material") | MB | s |"
echo "|---|---|---|"
for compression in none piz zip zip:1 zips; do
  least=$(for _ in 1 2 3; do seconds $compression; done | sort -n | head -1)
  echo "| $compression | $(cat packed/* | wc -c | awk '{ printf "%.1f", $1 / 1e6 }') | $least |"
done

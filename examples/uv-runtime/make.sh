#!/usr/bin/env bash
# Makes a page that shows a material sampled at run time through its uv map, beside the resolved one: uv-runtime.html
# here, or OUT/uv-runtime.html. Without a folder of maps it generates bricks.
# Usage: examples/uv-runtime/make.sh [FOLDER_OF_MAPS]
# Variables: OUT (folder for the page and the files it is made of), SIZE (of the uv map; 1024x1024), QUALITY, SEED,
# TERRAZZO (the program; build/terrazzo).
set -euo pipefail
here=$(realpath "$(dirname "$0")")
root=$here/../..
program=${TERRAZZO:-$root/build/terrazzo}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-uv-runtime.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
files=${OUT:-$scratch}
page=${OUT:-$here}/uv-runtime.html
mkdir -p "$files"

maps=${1:-}
if [ -z "$maps" ]; then
  maps=$scratch/bricks
  "$program" run "$root/graphs/generate-exemplar.json" --set type=bricks --set size=256x256 --set "out=$maps" --progress none
fi
rm -rf "$files/exemplar"
"$program" run "$here/uv-runtime.json" --set "material=$(realpath "$maps")" --set "out=$(realpath "$files")" \
  --set "size=${SIZE:-1024x1024}" --set "quality=${QUALITY:-normal}" --set "seed=${SEED:-1}" --progress none

{
  for map in "$files"/exemplar/*.png; do
    printf '<img hidden data-map="%s" src="data:image/png;base64,%s">\n' "$(basename "$map" .png)" "$(base64 -w0 "$map")"
  done
  printf '<script type="text/plain" id="uv-file">%s</script>\n' "$(base64 -w0 "$files/uv.tif")"
} >"$scratch/data"

# Lines such as @@page.js@@ stand for files.
while IFS= read -r line; do
  case $line in
    @@data@@) cat "$scratch/data" ;;
    @@*@@) line=${line#@@} && cat "$here/${line%@@}" ;;
    *) printf '%s\n' "$line" ;;
  esac
done <"$here/template.html" >"$scratch/page"
mv "$scratch/page" "$page"
echo "$page: $(wc -c <"$page") bytes"

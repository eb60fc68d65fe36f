#!/usr/bin/env bash
# What is told of damaged image files: one byte altered at 32 places, and the end cut off at 16, in every format and
# compression that is read. "harmless": the pixels are right all the same. "silent": a wrong picture without a word. The
# table goes into experiments.md. Builds the bench preset; needs oiiotool (openimageio-tools).
# Usage: tests/bench/damage.sh FOLDER   of a material with basecolor.png and height.png
# TERRAZZO_DAMAGE=PROGRAM: a terrazzo_damage that is built already.
set -euo pipefail
[ $# -eq 1 ] && [ -f "$1/basecolor.png" ] && [ -f "$1/height.png" ] || { sed -n '2,6s/^# //p' "$0"; exit 2; }
material=$(realpath "$1")
cd "$(dirname "$0")/../.."
command -v oiiotool >/dev/null || { echo "there is no oiiotool; install openimageio-tools" >&2; exit 2; }
if [ -z "${TERRAZZO_DAMAGE:-}" ]; then
  {
    cmake --preset bench
    cmake --build --preset bench --target terrazzo_damage
  } >&2
fi
work=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-damage.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir "$work/copies"

# make NAME MAP OPTIONS...: a part of a map as a file of that name.
make() { oiiotool "$material/$2.png" --cut 192x160+32+32 "${@:3}" -o "$work/$1"; }
make colour.png basecolor -d uint8
make height-16.png height -d uint16
make colour.jpg basecolor -d uint8 --quality 92
make colour-lossy.webp basecolor -d uint8 --compression webp:90

make colour.bmp basecolor -d uint8
make colour.gif basecolor -d uint8
make colour-raw.tga basecolor -d uint8 --compression none
make colour-rle.tga basecolor -d uint8 --compression rle
make colour.hdr basecolor -d float
for c in none lzw packbits zip; do make "colour-$c.tif" basecolor -d uint8 --compression $c; done
make height-lzw.tif height -d uint16 --compression lzw
make height-zip.tif height -d float --compression zip
for c in none rle zips zip piz pxr24 b44 dwaa; do make "colour-$c.exr" basecolor -d half --compression $c; done
make height-piz.exr height -d float --compression piz
make tiles-zip.exr basecolor -d half --tile 64 64 --compression zip
oiiotool "$work/colour-zip.exr" --attrib oiio:subimagename colour "$work/height-piz.exr" --attrib oiio:subimagename height \
  --siappend --compression zip -o "$work/parts-zip.exr"
oiiotool "$work/colour-zip.exr" --attrib oiio:subimagename colour "$work/height-piz.exr" --attrib oiio:subimagename height \
  --siappend --compression none -o "$work/parts-none.exr"

ls "$work"/*.* >&2
"${TERRAZZO_DAMAGE:-build-bench/tests/bench/terrazzo_damage}" "$work/copies" "$work"/*.*

#!/usr/bin/env bash
# Makes the pictures of blender.md: a wall before and after, by Cycles, and a screenshot of the panel. Needs a build, Blender,
# and Debian's packages xvfb, xauth, libgl1-mesa-dri, webp and openimageio-tools.
# Usage: examples/guide/blender_pictures.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")"
here=$PWD
program=$(realpath "${1:-../../build/terrazzo}")
for tool in blender xvfb-run cwebp oiiotool; do
  command -v "$tool" >/dev/null || { echo "there is no $tool" >&2; exit 1; }
done
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-blender-pictures.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
export BLENDER_USER_CONFIG=$scratch/config BLENDER_USER_SCRIPTS=$scratch/scripts
mkdir config scripts
"$program" run stock:generate-exemplar --set type=cobbles --set size=256 --set out=maps --progress none
"$program" blender-addon -o addon.zip
arguments=("$scratch/addon.zip" "$scratch/maps" "$scratch")
blender --background --factory-startup --python-exit-code 1 --python "$here/blender_pictures.py" -- wall "${arguments[@]}" >wall.log ||
  { cat wall.log; exit 1; }
oiiotool before.png after.png --mosaic:pad=8 1x2 --ch R,G,B -o both.png
cwebp -quiet -q 80 -m 6 both.png -o "$here/pictures/blender.webp"
xvfb-run -a -s "-screen 0 1500x1040x24" blender --factory-startup -p 0 0 1500 1040 --python "$here/blender_pictures.py" \
  -- panel "${arguments[@]}" >panel.log
[ -f panel.png ] || { cat panel.log; exit 1; }
cwebp -quiet -q 86 -m 6 panel.png -o "$here/pictures/blender-panel.webp"
ls -l "$here"/pictures/blender*.webp

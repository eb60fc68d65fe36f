#!/usr/bin/env bash
# The preset `godot` as Godot 3 shows it, compared with `preview`; spoilt ones have to differ (tests/readers/godot.gd). Only
# in the long form of the tests: tests/run.sh -C long. Skips, with exit code 77, where there is no Godot or no X server
# without a screen.
# Usage: tests/godot_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: godot_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: godot_test.sh SOURCE_FOLDER PROGRAM}")
for needed in godot3 xvfb-run; do
  command -v $needed >/dev/null || { echo "skipped: there is no $needed (apt-get install godot3 xvfb xauth libgl1-mesa-dri)"; exit 77; }
done
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-godot.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache HOME=$scratch
cd "$scratch"

cat >make.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"stones": {"type": "pattern", "kind": "cobbles", "size": 64, "relief": 1.5},
           "height": {"type": "get_map", "material": "@stones", "map": "height"},
           "metal": {"type": "levels", "image": "@height", "in_black": [0.4], "in_white": [0.9]},
           "with": {"type": "make_material", "material": "@stones", "images": ["@metal"], "names": ["metallic"], "semantics": ["metallic"]},
           "files": {"type": "export_preset", "material": "@with", "preset": "godot", "path": "right", "name": "stones"},
           "lit": {"type": "preview", "material": "@with", "size": 128, "relief": 0, "repeats": 2},
           "picture": {"type": "export", "material": "@lit", "path": "lit.png"}}}
JSON
"$program" run make.json --progress none

# spoil NAME FILE OPTION...: a copy with one of its images changed by oiiotool.
spoil() {
  cp -r right "$1"
  oiiotool "right/$2" "${@:3}" -o "$1/$2"
}
spoil green-flipped stones_normal.png --mulc 1,-1,1 --addc 0,1,0
spoil channels-swapped stones_orm.png --ch G,R,B
spoil three-reds stones_orm.png --ch R,R,R
for name in right green-flipped channels-swapped three-reds; do
  echo "$scratch/$name/stones 2 128 $scratch/$name.png"
done >jobs
LC_ALL=en_US.UTF-8 timeout 120 xvfb-run -a godot3 --video-driver GLES3 --audio-driver Dummy --script "$source/tests/readers/godot.gd" \
  "$scratch/jobs" >log 2>&1 || { cat log; exit 1; }

# differs NAME OPERATOR BOUND: how far its picture is from that of preview on average, of 255. Measured: 3.1, and 7.9 and more
# where it is spoilt.
failed=0
differs() {
  local mean
  mean=$(oiiotool lit.png --ch R,G,B "$1.png" --ch R,G,B --diff 2>&1 | sed -nE 's/.*Mean error = ([0-9.e-]+).*/\1/p' || true)
  echo "$1: the picture differs by $(awk "BEGIN { print ${mean:-9} * 255 }") of 255 on average"
  awk "BEGIN { exit !(${mean:-9} * 255 $2 $3) }" || { echo "WRONG: expected $2 $3"; failed=1; }
}
differs right '<' 3.8
for name in green-flipped channels-swapped three-reds; do differs $name '>' 3.8; done
exit $failed

#!/usr/bin/env bash
# Exports as Blender takes them: the script of the preset `blender` and glTF. Every map has to reach the place it is for, in
# its colour space, and a small picture by Cycles is compared with that of `preview`. Then exports are spoilt, and each has
# to show (tests/readers/blender.py). Only in the long form of the tests: tests/run.sh -C long. Skips, with exit code 77,
# where there is no Blender.
# Usage: tests/blender_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: blender_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: blender_test.sh SOURCE_FOLDER PROGRAM}")
command -v blender >/dev/null || { echo "skipped: there is no Blender (apt-get install blender python3-numpy)"; exit 77; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-blender.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"

# Stones of metal, so that every channel of the packed maps has something to say.
cat >make.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"stones": {"type": "pattern", "kind": "cobbles", "size": 64, "relief": 1.5},
           "height": {"type": "get_map", "material": "@stones", "map": "height"},
           "metal": {"type": "levels", "image": "@height", "in_black": [0.4], "in_white": [0.9]},
           "with": {"type": "make_material", "material": "@stones", "images": ["@metal"], "names": ["metallic"], "semantics": ["metallic"]},
           "script": {"type": "export_preset", "material": "@with", "preset": "blender", "path": "script", "name": "stones", "metres": [1.5],
                      "repeats": [2], "relief": 0.02},
           "gltf": {"type": "export_preset", "material": "@with", "preset": "gltf", "path": "gltf", "name": "stones", "metres": [1.5],
                    "repeats": [2]},
           "glb": {"type": "export_preset", "material": "@with", "preset": "glb", "path": "glb", "name": "stones", "metres": [1.5],
                   "repeats": [2]},
           "apart": {"type": "export", "material": "@with", "path": "maps/{map}.png"}}}
JSON
# Blender's surface has no place for occlusion.
cat >lit.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"open": {"type": "load_material", "path": "maps", "maps": {"ambient_occlusion": ""}},
           "lit": {"type": "preview", "material": "@open", "size": 128, "relief": 0, "repeats": 2},
           "file": {"type": "export", "material": "@lit", "path": "lit.png"}}}
JSON
"$program" run make.json --progress none
"$program" run lit.json --progress none
failed=0

# open FOLDER: what Blender says of the export there, in `said`. Pictures differ by what Cycles does differently; measured:
# 2.8 of 255 on average; spoilt ones differ by 4.9 and more, or in the nodes alone.
open() {
  local options=() file
  file=$(ls "$1"/*.gl[tb]* 2>/dev/null || true)
  [ -n "$file" ] || { options=(--python "$1/stones.py"); file=script; }
  local status=0
  blender --background --factory-startup --python-exit-code 1 "${options[@]}" --python "$source/tests/readers/blender.py" \
    -- "$file" 3 2 "$1.png" lit.png 3.6 >log 2>&1 || status=$?
  grep -E "differs by|^WRONG|Error" log | sed 's/^script: //' >said || status=1
  return $status
}

for folder in script gltf glb; do
  open "$folder" || failed=1
  sed "s/^/$folder: /" said
done

# spoilt NAME FOLDER FILE EXPRESSION: an export with its document changed by sed, which has to be found.
spoilt() {
  cp -r "$2" "$1"
  sed -zE "$4" "$2/$3" >"$1/$3"
  ! cmp -s "$2/$3" "$1/$3" || { echo "$1 changes nothing in $3"; exit 1; }
  if open "$1"; then
    echo "NOT SEEN: $1"
    failed=1
  fi
  grep -q '^WRONG' said || { cat log; failed=1; }
  sed "s/^/$1: /" said
}
spoilt curve-on-data script stones.py 's/(roughness.png", ?"color_space": ?)"Non-Color"/\1"sRGB"/'
spoilt height-as-scale script stones.py 's/displacement.inputs\["Height"\]/displacement.inputs["Scale"]/'
spoilt unconnected script stones.py 's/normal.outputs\["Normal"\]/normal.outputs["Normal"], surface.inputs["Tangent"])#/'
spoilt orm-unconnected gltf stones.gltf 's/"metallicRoughnessTexture"/"extras"/'
spoilt swapped gltf stones.gltf 's/_normal.png/_x.png/g; s/_base_color.png/_normal.png/g; s/_x.png/_base_color.png/g'
exit $failed

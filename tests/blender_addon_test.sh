#!/usr/bin/env bash
# The add-on for Blender, used in Blender: `terrazzo blender-addon` writes it, Blender installs it, and tests/addon/ makes
# materials with it; one is rendered by Cycles and compared with the picture of `preview`. Only in the long form of the
# tests: tests/run.sh -C long. Skips, with exit code 77, where there is no Blender.
# Usage: tests/blender_addon_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: blender_addon_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: blender_addon_test.sh SOURCE_FOLDER PROGRAM}")
command -v blender >/dev/null || { echo "skipped: there is no Blender (apt-get install blender python3-numpy)"; exit 77; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-addon.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
# Blender's own settings and add-ons stay as they are.
export TERRAZZO_CACHE=$scratch/cache BLENDER_USER_RESOURCES=$scratch/blender PYTHONDONTWRITEBYTECODE=1
export BLENDER_USER_CONFIG=$scratch/blender/config BLENDER_USER_SCRIPTS=$scratch/blender/scripts
export BLENDER_USER_DATAFILES=$scratch/blender/datafiles
mkdir -p "$scratch/blender"/{config,scripts,datafiles}
cd "$scratch"

"$program" run stock:generate-exemplar --set type=bricks --set size=64 --set out=maps --progress none
"$program" blender-addon -o addon.zip
# The base colour with 16 bits, as no 8-bit value has it, and in floats.
cat >deep.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"maps": {"type": "load_material", "path": "maps"},
           "soft": {"type": "load_map", "path": "maps/base_color.png"},
           "blurred": {"type": "blur", "image": "@soft", "radius": 1},
           "height": {"type": "get_map", "material": "@maps", "map": "height"},
           "both": {"type": "make_material", "images": ["@blurred", "@height"], "names": ["base_color", "height"]},
           "files": {"type": "export", "material": "@both", "path": "deep/{map}.png", "depth": "uint16"}}}
JSON
cat >dark.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"map": {"type": "load_map", "path": "maps/base_color.png"},
           "dark": {"type": "levels", "image": "@map", "out_white": [0.3]},
           "file": {"type": "export", "material": "@dark", "path": "dark.png"}}}
JSON
sed 's#deep/{map}.png#float/{map}.exr#; s/uint16/float/' deep.json >float.json

failed=0
for script in in_blender graphs_in_blender; do
  blender --background --factory-startup --python-exit-code 1 --python "$source/tests/addon/$script.py" -- \
    "$scratch/addon.zip" "$program" "$scratch/maps" "$scratch" >log 2>&1 || failed=1
  grep -E "^(ok|WRONG):" log || failed=1
  [ $failed = 0 ] || grep -v '^Fra:' log
done

# The picture: a wall of 3 m with the exemplar twice; a result of twice its pixels covers it once.
cat >shown.py <<'PY'
import os
import sys

import bpy

sys.path.insert(0, os.environ["ADDON_TESTS"])
from workbench import give, install, make, old_material, plane  # noqa: E402

install(os.path.abspath("addon.zip"), os.environ["TERRAZZO"], os.getcwd())
target = plane(3, 3)
# Without displacement nodes that the reader of exports would look for.
give(target, old_material(os.path.abspath("maps"), ("base_color", "normal", "height", "roughness")))
made = make(factor=2, quality="draft", seed=7)
os.symlink(made.request["out"], "shown")
PY
cat >lit.json <<'JSON'
{"terrazzo": 1,
 "nodes": {"open": {"type": "load_material", "path": "shown"},
           "lit": {"type": "preview", "material": "@open", "size": 128, "relief": 0},
           "file": {"type": "export", "material": "@lit", "path": "lit.png"}}}
JSON
export ADDON_TESTS=$source/tests/addon TERRAZZO=$program
status=0
blender --background --factory-startup --python-exit-code 1 --python shown.py >shown.log 2>&1 || status=1
[ $status = 0 ] && "$program" run lit.json --progress none || { cat shown.log; exit 1; }
rm shown
blender --background --factory-startup --python-exit-code 1 --python shown.py --python "$source/tests/readers/blender.py" \
  -- script 3 1 "$scratch/cycles.png" "$scratch/lit.png" 3.6 >picture.log 2>&1 || status=1
grep -E "differs by|^WRONG" picture.log || status=1
[ $status = 0 ] || { cat picture.log; failed=1; }
exit $failed

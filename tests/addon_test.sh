#!/usr/bin/env bash
# The add-on for Blender, as far as it needs no Blender: which images are taken from node trees, how the program is found,
# run and cancelled, masks, surfaces, graph files. Skips, with exit code 77, where Python has no NumPy.
# Usage: tests/addon_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: addon_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: addon_test.sh SOURCE_FOLDER PROGRAM}")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
"$python" -c "import numpy" 2>/dev/null || { echo "skipped: $python has no NumPy (apt-get install python3-numpy)"; exit 77; }
export PYTHONDONTWRITEBYTECODE=1
"$python" "$source/tests/addon/material_test.py" "$source"
"$python" "$source/tests/addon/program_test.py" "$source" "$program"

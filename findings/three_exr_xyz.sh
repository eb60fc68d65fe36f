#!/usr/bin/env bash
# three's EXRLoader takes normals in channels X, Y, Z for a grey picture of Y.
#
# Version:   three 0.187.0 (npm)
# Guess:     an error, as it gives for channels called Z or roughness, or X, Y, Z in order.
# Behaviour: any file that has a Y and no R, G, B counts as luminance, whatever else lies in it: red, green and blue are
#            all y, X and Z are dropped, and nothing is said. Two channels R and G are refused.
# Matters:   X, Y, Z is what renderers call the channels of normals and positions. The normal map loads, is grey, and turns
#            every normal towards the same diagonal. Files for the web need the names R, G, B.
# Seen on 2026-11-27:
#   X 0.25, Y 0.5, Z 0.75: 0.5 0.5 0.5 1
#   R 0.25, G 0.5, B 0.75: 0.25 0.5 0.75 1
#   R 0.25, G 0.5: refused
. "$(dirname "$0")/common/packages.bash"
node_packages three@0.187.0

python3 - <<'PY'
from pictures import write_exr
values = {0: 0.25, 1: 0.5, 2: 0.75}
for names in ("XYZ", "RGB", "RG"):
    window = (0, 0, 3, 3)
    write_exr(names + ".exr", {n: (lambda x, y, v=values[i]: v) for i, n in enumerate(names)}, window, window)
PY
cat >read.mjs <<'JS'
import fs from 'fs';
import {FloatType} from 'three';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
const file = fs.readFileSync(process.argv[2]);
try {
  const {data} = new EXRLoader().setDataType(FloatType).parse(new Uint8Array(file).buffer);
  console.log(...data.slice(0, 4));
} catch {
  console.log('refused');
}
JS
read_with() { node read.mjs "$1" 2>&1 | tail -n 1; }
expect "X 0.25, Y 0.5, Z 0.75" "$(read_with XYZ.exr)" "0.5 0.5 0.5 1"
expect "R 0.25, G 0.5, B 0.75" "$(read_with RGB.exr)" "0.25 0.5 0.75 1"
expect "R 0.25, G 0.5" "$(read_with RG.exr)" "refused"
finish

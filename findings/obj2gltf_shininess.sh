#!/usr/bin/env bash
# obj2gltf turns the number Ns into roughness, but takes the picture map_Ns for roughness as it is.
#
# Version:   obj2gltf 3.2.0, pngjs 7.0.0 (npm)
# Guess:     a large Ns is a smooth surface, so both the number and the picture are turned over.
# Behaviour: Ns 1000 becomes a roughness of 0; a white map_Ns becomes a roughness of 1. map_Ks goes into metallic beside
#            it, and the constant metallic becomes 1, though nothing in the file says metal.
# Matters:   materials in MTL, which most modelling programs and scan shops still write, come out with shiny and dull parts
#            exchanged, and as metal. Turn the picture over first, or put a roughness map into map_Ns on purpose.
# Seen on 2026-11-27:
#   Ns 1000: roughness 0, metallic 0
#   map_Ns 230, map_Ks 30: green 230, blue 30, metallic factor 1
. "$(dirname "$0")/common/packages.bash"
node_packages obj2gltf@3.2.0 pngjs@7.0.0

python3 - <<'PY'
from pictures import write_png
for name, v in (("shiny", 230), ("specular", 30)):
    write_png(name + ".png", [[(v,) * 3] * 4] * 4)
PY
cat >part.obj <<'OBJ'
mtllib part.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl stone
f 1/1 2/2 3/3
OBJ
cat >run.mjs <<'JS'
import fs from 'fs';
import pngjs from 'pngjs';
import obj2gltf from 'obj2gltf';
fs.writeFileSync('part.mtl', 'newmtl stone\nKd 0.5 0.5 0.5\n' + process.argv.slice(2).join('\n') + '\n');
const pictures = [];
const {materials} = await obj2gltf('part.obj', {
  logger: () => {}, separateTextures: true, outputDirectory: '.',
  writer: (file, bytes) => { if (file.endsWith('.png')) pictures.push(pngjs.PNG.sync.read(bytes).data); },
});
const {roughnessFactor, metallicFactor} = materials[0].pbrMetallicRoughness;
if (pictures.length) console.log(`green ${pictures[0][1]}, blue ${pictures[0][2]}, metallic factor ${metallicFactor}`);
else console.log(`roughness ${roughnessFactor}, metallic ${metallicFactor}`);
JS
expect "Ns 1000" "$(node run.mjs 'Ns 1000' 2>&1 | tail -n 1)" "roughness 0, metallic 0"
expect "map_Ns 230, map_Ks 30" "$(node run.mjs 'map_Ns shiny.png' 'map_Ks specular.png' 2>&1 | tail -n 1)" \
  "green 230, blue 30, metallic factor 1"
finish

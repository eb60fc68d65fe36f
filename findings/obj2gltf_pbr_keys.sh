#!/usr/bin/env bash
# obj2gltf drops what makes an MTL file a PBR material: map_Pr, map_Pm, norm, repeats and the strength of bumps.
#
# Version:   obj2gltf 3.2.0 (npm)
# Guess:     the PBR keys of MTL, which Blender and scanning programs write, are read; -bm becomes the normals' scale and
#            -s a texture transform. At least a warning.
# Behaviour: map_Pr, map_Pm, Pr, Pm, norm, -s and -bm are all dropped without a word. Only map_Bump is the normal map, at
#            full strength.
# Matters:   a photoscan arrives in a viewer as a flat, rough, stretched surface, and the log says that all went well.
# Seen on 2026-11-27:
#   textures of map_Kd, map_Pr, map_Pm, norm: baseColorTexture
#   Pr 0.3, Pm 0.9: roughness 1, metallic 0
#   textures of map_Kd -s 3 3 1, map_Bump -bm 0.5: baseColorTexture {"index":0}, normalTexture {"index":1}
#   warnings: 0
. "$(dirname "$0")/common/packages.bash"
node_packages obj2gltf@3.2.0

python3 - <<'PY'
from pictures import write_png
for i, name in enumerate(("color", "rough", "metal", "bumps")):
    write_png(name + ".png", [[(40 * i, 128, 255)] * 4] * 4)
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
import obj2gltf from 'obj2gltf';
let warnings = 0;
async function material(...lines) {
  fs.writeFileSync('part.mtl', ['newmtl stone', ...lines, ''].join('\n'));
  const {materials} = await obj2gltf('part.obj', {logger: () => warnings++});
  return {...materials[0].pbrMetallicRoughness, ...materials[0]};
}
const textures = m => Object.keys(m).filter(k => k.endsWith('Texture'));
console.log(...textures(await material('map_Kd color.png', 'map_Pr rough.png', 'map_Pm metal.png', 'norm bumps.png')));
const constants = await material('Kd 0.5 0.5 0.5', 'Pr 0.3', 'Pm 0.9');
console.log(`roughness ${constants.roughnessFactor}, metallic ${constants.metallicFactor}`);
const repeated = await material('map_Kd -s 3 3 1 color.png', 'map_Bump -bm 0.5 bumps.png');
console.log(textures(repeated).map(t => `${t} ${JSON.stringify(repeated[t])}`).join(', '));
console.log(warnings);
JS
node run.mjs >said 2>&1
expect "textures of map_Kd, map_Pr, map_Pm, norm" "$(sed -n 1p said)" "baseColorTexture"
expect "Pr 0.3, Pm 0.9" "$(sed -n 2p said)" "roughness 1, metallic 0"
expect "textures of map_Kd -s 3 3 1, map_Bump -bm 0.5" "$(sed -n 3p said)" \
  'baseColorTexture {"index":0}, normalTexture {"index":1}'
expect "warnings" "$(sed -n 4p said)" "0"
finish

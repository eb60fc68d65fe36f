#!/usr/bin/env bash
# Exports as independent readers take them: glTF by Khronos' validator, USD by TinyUSDZ, both from the npm registry. Skips,
# with exit code 77, where there is no npm or it cannot reach the registry.
# Usage: tests/readers_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: readers_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: readers_test.sh SOURCE_FOLDER PROGRAM}")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-readers.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
cd "$scratch"

command -v npm >/dev/null || { echo "skipped: there is no npm to get the readers with"; exit 77; }
npm install --silent --no-audit --no-fund gltf-validator@2.0.0-dev.3.10 tinyusdz@0.9.0-rc10 >npm.log 2>&1 ||
  { echo "skipped: npm cannot get the readers: $(tail -1 npm.log)"; exit 77; }

cat >validate.js <<'JS'
// Prints every message, and fails on any.
const fs = require('fs'), path = require('path'), validator = require('gltf-validator');
const file = process.argv[2];
const read = name => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(name))));
validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
  externalResourceFunction: uri => Promise.resolve(read(uri)),
}).then(report => {
  for (const m of report.issues.messages) console.log(file, m.code, m.message, m.pointer);
  process.exit(report.issues.messages.length ? 1 : 0);
}, error => { console.log(file, String(error)); process.exit(1); });
JS

"$program" run "$source/graphs/generate-exemplar.json" --progress none --set type=bricks --set size=64 --set out=bricks
cat >export.json <<'JSON'
{"terrazzo": 1, "parameters": {"preset": {"type": "choice", "choices": ["gltf", "glb", "usd"]}, "format": {"type": "choice", "choices": ["png", "jpg"]},
                               "repeats": {"type": "number", "default": 1}, "maps": {"type": "path"}},
 "nodes": {"maps": {"type": "load_material", "path": "$maps", "metres": [1.5]},
           "files": {"type": "export_preset", "material": "@maps", "preset": "$preset", "format": "$format", "path": "$preset-$format-$repeats",
                     "name": "old bricks", "repeats": ["$repeats"]}}}
JSON
mkdir plain && cp bricks/base_color.png plain
failed=0
for preset in gltf glb; do
  for format in png jpg; do
    for repeats in 1 2.5; do
      "$program" run export.json --progress none --set preset=$preset --set format=$format --set repeats=$repeats --set maps=bricks
      node validate.js "$preset-$format-$repeats/old_bricks.$preset" || failed=1
    done
  done
done
"$program" run export.json --progress none --set preset=gltf --set format=png --set repeats=1 --set maps=plain
node validate.js gltf-png-1/old_bricks.gltf || failed=1

# The validator itself finds what is wrong: tangents of another handedness than 1 or -1, and an image that is not there.
sed 's/"TANGENT": 2/"TANGENT": 1/' gltf-png-2.5/old_bricks.gltf >gltf-png-2.5/wrong.gltf
node validate.js gltf-png-2.5/wrong.gltf >said && { echo "tangents of three components passed"; failed=1; }
sed 's/old_bricks_normal/old_bricks_norm/' gltf-png-2.5/old_bricks.gltf >gltf-png-2.5/wrong.gltf
node validate.js gltf-png-2.5/wrong.gltf >said && { echo "an image that is not there passed"; failed=1; }

cat >web.mjs <<'JS'
// The reader is built for browsers.
globalThis.window = globalThis;
process.type = 'renderer';
JS
cat >read.mjs <<'JS'
// Prints what is wrong with a USD file of the material on its plane.
import './web.mjs';
import fs from 'fs';
import start from 'tinyusdz/tinyusdz.js';
const [file, width] = process.argv.slice(2);
const module = await start({wasmBinary: fs.readFileSync('node_modules/tinyusdz/tinyusdz.wasm')});
const reader = new module.TinyUSDZLoaderNative();
const wrong = [];
if (!reader.loadFromBinary(new Uint8Array(fs.readFileSync(file)), file)) wrong.push(`it cannot be read: ${reader.error()}`);
else {
  const material = reader.getMaterial(0), points = [...reader.getMesh(0).points];
  for (const input of ['diffuseColor', 'normal', 'roughness', 'occlusion']) {
    const texture = reader.getTexture(material[input + 'TextureId'] ?? -1);
    if (texture?.wrapS !== 'repeat' || texture?.wrapT !== 'repeat') wrong.push(`${input} has no texture that repeats`);
    const image = texture?.textureImageId, space = image === undefined ? '' : reader.getImage(image).usdColorSpace;
    if (space && space !== (input === 'diffuseColor' ? 'srgb' : 'raw')) wrong.push(`${input} has colour space ${space}`);
  }
  if (material.useSpecularWorkflow) wrong.push('it uses the specular workflow');
  const extent = Math.max(...points) - Math.min(...points);
  if (Math.abs(extent - width) > 1e-6) wrong.push(`the plane is ${extent} m wide`);
}
for (const w of wrong) console.log(file, w);
process.exit(wrong.length ? 1 : 0);
JS
"$program" run export.json --progress none --set preset=usd --set format=png --set repeats=2 --set maps=bricks
node read.mjs usd-png-2/old_bricks.usda 3 || failed=1
grep -v wrapT usd-png-2/old_bricks.usda >wrong.usda
node read.mjs wrong.usda 3 >said && { echo "textures that do not repeat passed"; failed=1; }
sed 's/"raw"/"auto"/' usd-png-2/old_bricks.usda >wrong.usda
node read.mjs wrong.usda 3 >said && { echo "data maps whose colour space is left open passed"; failed=1; }
sed 's/inputs:roughness.connect/inputs:rougness.connect/' usd-png-2/old_bricks.usda >wrong.usda
node read.mjs wrong.usda 3 >said && { echo "a map that is left unconnected passed"; failed=1; }
exit $failed

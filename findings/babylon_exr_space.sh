#!/usr/bin/env bash
# Babylon.js marks every EXR texture as encoded, and gives it no format.
#
# Version:   @babylonjs/core 9.31.0 (npm)
# Guess:     an EXR texture is marked linear, and its format follows from its channels.
# Behaviour: the loader asks the file's header for both, where neither is. So the texture counts as being in gamma space,
#            also with R, G and B, and its format is undefined, though one value a pixel comes for Y and two for R, G. The
#            decoder beside it has set both.
# Matters:   a base colour or emission in EXR is decoded a second time and comes out dark, and a grey EXR height is handed
#            on as a picture of unknown channels. Set gammaSpace = false on the texture, and use RGB.
# Seen on 2026-11-27:
#   R, G, B: in gamma space true, format undefined, 4 values a pixel
#   R, G: in gamma space true, format undefined, 2 values a pixel
#   Y: in gamma space true, format undefined, 1 value a pixel
. "$(dirname "$0")/common/packages.bash"
node_packages @babylonjs/core@9.31.0

python3 - <<'PY'
from pictures import write_exr
for names in ("RGB", "RG", "Y"):
    window = (0, 0, 3, 3)
    write_exr(names + ".exr", {n: lambda x, y: 0.5 for n in names}, window, window)
PY
cat >read.mjs <<'JS'
import fs from 'fs';
import {_ExrTextureLoader} from '@babylonjs/core/Materials/Textures/Loaders/exrTextureLoader.js';
const file = new Uint8Array(fs.readFileSync(process.argv[2]));
let uploaded;
const texture = {getEngine: () => ({_uploadDataToTextureDirectly: (_, data) => { uploaded = data; }})};
new _ExrTextureLoader().loadData(file, texture, (width, height, levels, compressed, done) => {
  done();
  const each = uploaded.length / (width * height);
  console.log(`in gamma space ${texture._gammaSpace}, format ${texture.format}, ${each} value${each > 1 ? 's' : ''} a pixel`);
});
JS
read_with() { timeout 60 node read.mjs "$1" 2>&1 | tail -n 1; }
expect "R, G, B" "$(read_with RGB.exr)" "in gamma space true, format undefined, 4 values a pixel"
expect "R, G" "$(read_with RG.exr)" "in gamma space true, format undefined, 2 values a pixel"
expect "Y" "$(read_with Y.exr)" "in gamma space true, format undefined, 1 value a pixel"
finish

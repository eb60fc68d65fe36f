#!/usr/bin/env bash
# three's EXRLoader stretches the data window over the whole texture.
#
# Version:   three 0.187.0 (npm)
# Guess:     an image of the size of the display window, with zeros where the file has no data.
# Behaviour: the texture is the data window alone. Of a picture of 8x8 whose data lie in 4x4 pixels at (2, 1) comes a
#            texture of 4x4, and the display window is not used at all.
# Matters:   renderers and compositors crop EXR files to what is not empty. Maps of one material that are cropped
#            differently no longer lie over one another: the colour is stretched by one factor, the height by another.
#            Crop nothing, or all maps alike, before they go to the web.
# Seen on 2026-11-27:
#   display 8x8, data 4x4: 4x4
#   display 8x8, data 8x8: 8x8
. "$(dirname "$0")/common/packages.bash"
node_packages three@0.187.0

python3 - <<'PY'
from pictures import write_exr
channels = {n: lambda x, y: 0.5 for n in "RGB"}
write_exr("cropped.exr", channels, (2, 1, 5, 4), (0, 0, 7, 7))
write_exr("whole.exr", channels, (0, 0, 7, 7), (0, 0, 7, 7))
PY
cat >read.mjs <<'JS'
import fs from 'fs';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
const {width, height} = new EXRLoader().parse(new Uint8Array(fs.readFileSync(process.argv[2])).buffer);
console.log(`${width}x${height}`);
JS
expect "display 8x8, data 4x4" "$(node read.mjs cropped.exr 2>&1 | tail -n 1)" "4x4"
expect "display 8x8, data 8x8" "$(node read.mjs whole.exr 2>&1 | tail -n 1)" "8x8"
finish

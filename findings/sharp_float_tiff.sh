#!/usr/bin/env bash
# sharp reads floats of one channel on a scale of 0 to 255, and floats of three as linear light.
#
# Version:   sharp 0.35.5 (npm)
# Guess:     a TIFF of floats between 0 and 1 becomes 0 to 255, the same for grey and for colours.
# Behaviour: grey of 0.5 becomes 0 or 1: floats of one channel are taken as they are. The same value in three channels
#            becomes 188: it counts as linear light and is encoded as sRGB.
# Matters:   heights in float TIFF come out black, whatever they hold, and normals in float TIFF come out bent. Heights can
#            be read with raw({depth: 'float'}) and scaled by hand; normals need to be brought to integers elsewhere.
# Seen on 2026-11-27:
#   grey of 0.5: 0
#   three channels of 0.5: 188
#   grey of 0.5 as floats: 0.5
#   three channels of 0.5 as floats: 188
. "$(dirname "$0")/common/packages.bash"
node_packages sharp@0.35.5

python3 - <<'PY'
from pictures import write_tiff
write_tiff("grey.tif", [[(0.5,)] * 4] * 4)
write_tiff("color.tif", [[(0.5,) * 3] * 4] * 4)
PY
cat >run.mjs <<'JS'
import sharp from 'sharp';
const [file, depth] = process.argv.slice(2);
const data = await sharp(file).raw(depth ? {depth} : {}).toBuffer();
console.log(depth ? data.readFloatLE(0) : data[0]);
JS
node -e "import('sharp')" >said 2>&1 || skip "sharp has no binary for this machine"
expect "grey of 0.5" "$(node run.mjs grey.tif)" "0"
expect "three channels of 0.5" "$(node run.mjs color.tif)" "188"
expect "grey of 0.5 as floats" "$(node run.mjs grey.tif float)" "0.5"
expect "three channels of 0.5 as floats" "$(node run.mjs color.tif float | cut -c-3)" "188"
finish

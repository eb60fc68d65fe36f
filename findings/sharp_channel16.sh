#!/usr/bin/env bash
# sharp takes a 16-bit channel out of a picture only if the result is called rgb16; grey16 is refused.
#
# Version:   sharp 0.35.5 (npm)
# Guess:     extractChannel of a 16-bit PNG gives a 16-bit grey picture, or does so with toColourspace('grey16').
# Behaviour: without more it is reduced to 8 bits. grey16 is applied before the channel is taken, and then there is no
#            channel 1. With rgb16, the name of a space of three channels, one channel of 16 bits comes out.
# Matters:   taking roughness or height out of a packed 16-bit map is the commonest job of a texture script. The obvious
#            call loses eight bits without a word, and the obvious remedy fails.
# Seen on 2026-11-27:
#   as it is: 1 channel of uchar: 78
#   grey16: Cannot extract channel 1 from image with channels 0-0
#   rgb16: 1 channel of ushort: 20000
. "$(dirname "$0")/common/packages.bash"
node_packages sharp@0.35.5

python3 - <<'PY'
from pictures import write_png
write_png("packed.png", [[(10000, 20000, 30000)] * 4] * 4, 16)
PY
cat >run.mjs <<'JS'
import sharp from 'sharp';
const space = process.argv[2];
try {
  let green = sharp('packed.png').extractChannel('green');
  if (space) green = green.toColourspace(space);
  const {data, info} = await green.raw({depth: space ? 'ushort' : 'uchar'}).toBuffer({resolveWithObject: true});
  const value = space ? data.readUInt16LE(0) : data[0];
  console.log(`${info.channels} channel${info.channels > 1 ? 's' : ''} of ${info.depth}: ${value}`);
} catch (e) {
  console.log(e.message);
}
JS
node -e "import('sharp')" >said 2>&1 || skip "sharp has no binary for this machine"
expect "as it is" "$(node run.mjs)" "1 channel of uchar: 78"
expect "grey16" "$(node run.mjs grey16)" "Cannot extract channel 1 from image with channels 0-0"
expect "rgb16" "$(node run.mjs rgb16)" "1 channel of ushort: 20000"
finish

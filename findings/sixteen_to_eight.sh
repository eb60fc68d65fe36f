#!/usr/bin/env bash
# Of 16-bit PNG files sharp, a canvas, UPNG and cwebp keep the upper byte; pngjs and OpenImageIO round.
#
# Version:   sharp 0.35.5, @napi-rs/canvas 1.1.1, upng-js 2.1.0, pngjs 7.0.0 (npm); webp 1.2.4-0.2+deb12u1 (Debian 12)
# Guess:     all round to the nearest byte, v / 257.
# Behaviour: all but pngjs drop the lower byte: 255 of 65535 is 0, not 1. Every value is lower by 0.5 of 255 on average,
#            and half of all values by one step. (oiiotool of Debian's OpenImageIO rounds, too.)
# Matters:   two readers of one 16-bit map differ in half of their pixels, which looks like a fault in the exporter. And
#            what is read in 8 bits, written in 16 and read again stays the same only with v * 257, not with a shift.
# Seen on 2026-11-27, of 0 128 129 255 256 384 385 32767 65408:
#   sharp: 0 0 0 0 1 1 1 127 255
#   canvas: 0 0 0 0 1 1 1 127 255
#   upng: 0 0 0 0 1 1 1 127 255
#   cwebp: 0 0 0 0 1 1 1 127 255
#   pngjs: 0 0 1 1 1 1 1 127 255
. "$(dirname "$0")/common/packages.bash"
debian webp=1.2.4-0.2+deb12u1
node_packages sharp@0.35.5 @napi-rs/canvas@1.1.1 upng-js@2.1.0 pngjs@7.0.0

python3 - <<'PY'
from pictures import write_png
write_png("steps.png", [[(v,) * 3 for v in (0, 128, 129, 255, 256, 384, 385, 32767, 65408)]], 16)
PY
cat >run.mjs <<'JS'
import fs from 'fs';
const bytes = fs.readFileSync('steps.png');
const readers = {
  sharp: async () => (await import('sharp')).default('steps.png').ensureAlpha().raw().toBuffer(),
  canvas: async () => {
    const {createCanvas, loadImage} = await import('@napi-rs/canvas');
    const image = await loadImage('steps.png'), page = createCanvas(9, 1).getContext('2d');
    page.drawImage(image, 0, 0);
    return page.getImageData(0, 0, 9, 1).data;
  },
  upng: async () => {
    const {default: UPNG} = await import('upng-js');
    return new Uint8Array(UPNG.toRGBA8(UPNG.decode(new Uint8Array(bytes).buffer))[0]);
  },
  pngjs: async () => (await import('pngjs')).default.PNG.sync.read(bytes).data,
};
console.log(...[...await readers[process.argv[2]]()].filter((_, i) => i % 4 === 0));
JS
for reader in sharp canvas upng; do
  got=$(node run.mjs $reader 2>error) || skip "$reader does not start: $(tail -n 1 error)"
  expect $reader "$got" "0 0 0 0 1 1 1 127 255"
done
cwebp -quiet -lossless steps.png -o steps.webp && dwebp -quiet steps.webp -o back.png || skip "cwebp does not start"
expect cwebp "$(python3 -c 'from pictures import read_png; print(*[p[0] for p in read_png("back.png")[0][0]])')" \
  "0 0 0 0 1 1 1 127 255"
expect pngjs "$(node run.mjs pngjs)" "0 0 1 1 1 1 1 127 255"
finish

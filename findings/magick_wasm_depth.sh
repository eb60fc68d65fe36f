#!/usr/bin/env bash
# ImageMagick for the web says that a height map has 16 bits, and keeps 8.
#
# Version:   @imagemagick/magick-wasm 0.0.43 (npm)
# Guess:     built with 16 bits a channel, as ImageMagick is by default and in Debian.
# Behaviour: built with 8 (its version says Q8). A 16-bit PNG still reports a depth of 16 after reading, but its pixels have
#            been reduced: 4096 heights become 17, and what is written is an 8-bit file.
# Matters:   a web page that only crops or rotates height maps returns them with steps, and the depth that it shows to its
#            user is the right one.
# Seen on 2026-11-27:
#   depth reported: 16
#   depth written: 8
#   heights: 4096 became 17
. "$(dirname "$0")/common/packages.bash"
node_packages @imagemagick/magick-wasm@0.0.43

python3 - <<'PY'
from pictures import write_png
write_png("height.png", [[(y * 64 + x,) for x in range(64)] for y in range(64)], 16)
PY
cat >run.mjs <<'JS'
import fs from 'fs';
import {initializeImageMagick, ImageMagick, MagickFormat} from '@imagemagick/magick-wasm';
await initializeImageMagick(fs.readFileSync('node_modules/@imagemagick/magick-wasm/dist/x86/magick.wasm'));
ImageMagick.read(fs.readFileSync('height.png'), image => {
  console.log(image.depth);
  image.write(MagickFormat.Png, bytes => fs.writeFileSync('out.png', bytes));
});
JS
reported=$(node run.mjs 2>error) || skip "the library does not start: $(tail -n 1 error)"
expect "depth reported" "$reported" "16"
expect "depth written" "$(python3 -c 'from pictures import read_png; print(read_png("out.png")[1])')" "8"
left=$(python3 -c 'from pictures import read_png; print(len({pixel for row in read_png("out.png")[0] for pixel in row}))')
expect "heights" "4096 became $left" "4096 became 17"
finish

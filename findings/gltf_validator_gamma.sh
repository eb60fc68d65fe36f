#!/usr/bin/env bash
# Khronos' validator warns of colour profiles in glTF's pictures, but not of gamma, which readers disagree on.
#
# Version:   gltf-validator 2.0.0-dev.3.10, sharp 0.35.5, @napi-rs/canvas 1.1.1 (npm)
# Guess:     glTF wants such data in pictures ignored, so the validator warns of gAMA and cICP as it does of a profile.
# Behaviour: IMAGE_FEATURES_UNSUPPORTED comes for iCCP alone. A gAMA chunk of 1.0 gives no message, though the report calls
#            the picture linear, and cICP (here BT.2020 and PQ) is not seen. Meanwhile a canvas brightens the same file,
#            and sharp does not.
# Matters:   programs that work in linear light write gAMA 1.0. Base colour from such a file passes every check, and then
#            depends on the reader: 128 in one, 188 in the other. Strip the chunk; look into the report's "transfer".
# Seen on 2026-11-27:
#   nothing: no message, transfer srgb; sharp 128, canvas 128
#   gAMA 1.0: no message, transfer linear; sharp 128, canvas 188
#   cICP 9 16 0 1: no message, transfer srgb; sharp 128, canvas 128
#   iCCP: IMAGE_FEATURES_UNSUPPORTED, transfer custom
. "$(dirname "$0")/common/packages.bash"
node_packages gltf-validator@2.0.0-dev.3.10 sharp@0.35.5 @napi-rs/canvas@1.1.1

python3 - <<'PY'
import struct
import zlib
from pictures import write_png

def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

write_png("plain.png", [[(128,) * 3] * 4] * 4)
plain = open("plain.png", "rb").read()
profile = b"x\0\0" + zlib.compress(bytes(128))
for name, more in (("gamma", chunk(b"gAMA", struct.pack(">I", 100000))), ("cicp", chunk(b"cICP", bytes([9, 16, 0, 1]))),
                   ("profile", chunk(b"iCCP", profile))):
    open(name + ".png", "wb").write(plain[:33] + more + plain[33:])
PY
cat >look.mjs <<'JS'
import fs from 'fs';
import validator from 'gltf-validator';
import sharp from 'sharp';
import {createCanvas, loadImage} from '@napi-rs/canvas';
const [file, shown] = process.argv.slice(2);
const document = {
  asset: {version: '2.0'}, images: [{uri: file}], textures: [{source: 0}],
  materials: [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}],
};
const {issues, info} = await validator.validateString(JSON.stringify(document), {
  externalResourceFunction: async () => new Uint8Array(fs.readFileSync(file)),
});
const codes = issues.messages.map(m => m.code).filter(c => c !== 'UNUSED_OBJECT');
let said = `${codes.join(' ') || 'no message'}, transfer ${info.resources[0].image.transfer}`;
if (shown) {
  const page = createCanvas(4, 4).getContext('2d');
  page.drawImage(await loadImage(file), 0, 0);
  said += `; sharp ${(await sharp(file).raw().toBuffer())[0]}, canvas ${page.getImageData(0, 0, 1, 1).data[0]}`;
}
console.log(said);
JS
look() { node look.mjs "$@" 2>&1 | tail -n 1; }
expect "nothing" "$(look plain.png shown)" "no message, transfer srgb; sharp 128, canvas 128"
expect "gAMA 1.0" "$(look gamma.png shown)" "no message, transfer linear; sharp 128, canvas 188"
expect "cICP 9 16 0 1" "$(look cicp.png shown)" "no message, transfer srgb; sharp 128, canvas 128"
expect "iCCP" "$(look profile.png)" "IMAGE_FEATURES_UNSUPPORTED, transfer custom"
finish

#!/usr/bin/env bash
# ktx2-encoder's transform for glTF writes every texture, normals and roughness too, as sRGB.
#
# Version:   ktx2-encoder 0.6.0, @gltf-transform/core 4.5.1, ktx-parse 2.0.0, pngjs 7.0.0 (npm)
# Guess:     the transform knows the slots, so base colour is marked sRGB (2), the data maps linear (1). And where the
#            encoder is called alone, isPerceptual: false gives linear.
# Behaviour: all textures are marked sRGB. Alone, isPerceptual: false stays sRGB as well; isNormalMap or
#            isSetKTX2SRGBTransferFunc: false give linear, and the transform has no way to say so by slot.
# Matters:   loaders of KTX2 take the colour space from the file. Roughness of 0.5 is decoded to 0.21, normals bend, and the
#            same document with PNG files is right. Encode data maps by hand before they go into the document.
# Seen on 2026-11-27:
#   base colour, roughness, normal, occlusion: 2 2 2 2
#   alone, isPerceptual: false, isNormalMap, isSetKTX2SRGBTransferFunc: false: 2 2 1 1
. "$(dirname "$0")/common/packages.bash"
node_packages ktx2-encoder@0.6.0 @gltf-transform/core@4.5.1 @gltf-transform/extensions@4.5.1 \
  @gltf-transform/functions@4.5.1 ktx-parse@2.0.0 pngjs@7.0.0

cat >encode.mjs <<'JS'
import {Document} from '@gltf-transform/core';
import {read} from 'ktx-parse';
import {encodeToKTX2} from 'ktx2-encoder';
import {ktx2} from 'ktx2-encoder/gltf-transform';
import pngjs from 'pngjs';
const {PNG} = pngjs;
const say = console.log;
console.log = () => {};  // the encoder's own
const png = (...color) => {
  const picture = new PNG({width: 16, height: 16});
  for (let i = 0; i < 256; i++) picture.data.set([...color, 255], 4 * i);
  return new Uint8Array(PNG.sync.write(picture));
};
const imageDecoder = async bytes => {
  const {width, height, data} = PNG.sync.read(Buffer.from(bytes));
  return {width, height, data: new Uint8Array(data)};
};
const transfer = file => read(file).dataFormatDescriptor[0].transferFunction;

const document = new Document();
const texture = (name, ...color) => document.createTexture(name).setMimeType('image/png').setImage(png(...color));
document.createMaterial()
  .setBaseColorTexture(texture('colour', 180, 90, 60)).setMetallicRoughnessTexture(texture('roughness', 0, 128, 0))
  .setNormalTexture(texture('normal', 140, 120, 250)).setOcclusionTexture(texture('occlusion', 200, 200, 200));
await document.transform(ktx2({imageDecoder, isUASTC: true, generateMipmap: false}));
say(...document.getRoot().listTextures().map(t => transfer(t.getImage())));

const alone = [];
for (const more of [{}, {isPerceptual: false}, {isNormalMap: true}, {isSetKTX2SRGBTransferFunc: false}])
  alone.push(transfer(await encodeToKTX2(png(140, 120, 250), {imageDecoder, isUASTC: true, isKTX2File: true, ...more})));
say(...alone);
JS
node encode.mjs >said 2>error || skip "the encoder does not run: $(tail -n 1 error)"
expect "base colour, roughness, normal, occlusion" "$(grep -E '^[12 ]+$' said | sed -n 1p)" "2 2 2 2"
expect "alone, isPerceptual: false, isNormalMap, isSetKTX2SRGBTransferFunc: false" \
  "$(grep -E '^[12 ]+$' said | sed -n 2p)" "2 2 1 1"
finish

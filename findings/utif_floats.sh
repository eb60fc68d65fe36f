#!/usr/bin/env bash
# utif2 wraps float heights round, and reads those that OpenImageIO packs as noise.
#
# Version:   utif2 4.1.0, three 0.187.0, tiff 7.1.3, geotiff 3.0.5 (npm)
# Guess:     floats below 0 are 0 and above 1 are 255; the predictor for floats (3) is undone or refused.
# Behaviour: utif2, and three's TIFFLoader, which has it inside, multiply by 255 and keep the lower byte, so 1.25 is 63. The
#            predictor is passed over in silence, and bytes of floats come out as grey. tiff refuses that file; geotiff reads
#            both exactly.
# Matters:   OpenImageIO, when asked for zip, writes floats with predictor 3. Such a displacement map looks
#            like noise in a web viewer, and heights that are not kept within 0 to 1 get cliffs.
# Seen on 2026-11-27, of 0, 0.5, 1, 1.25:
#   three, plain: 0 128 255 63
#   utif2, plain: 0 128 255 63
#   utif2, predictor 3: other values
#   tiff, predictor 3: invalid predictor: 3
#   geotiff, predictor 3: 0 0.5 1 1.25
. "$(dirname "$0")/common/packages.bash"
node_packages utif2@4.1.0 three@0.187.0 tiff@7.1.3 geotiff@3.0.5

python3 - <<'PY'
from pictures import write_tiff
rows = [[(v,) for v in (0, 0.5, 1, 1.25)]] * 4
write_tiff("plain.tif", rows)
write_tiff("apart.tif", rows, floats_apart=True)
PY
cat >read.mjs <<'JS'
import fs from 'fs';
const [library, file] = process.argv.slice(2);
const bytes = new Uint8Array(fs.readFileSync(file));
const firsts = data => [...data].filter((_, i) => i % 4 === 0).slice(0, 4);
const readers = {
  utif2: async () => {
    const {default: UTIF} = await import('utif2');
    const [page] = UTIF.decode(bytes.buffer);
    UTIF.decodeImage(bytes.buffer, page);
    return firsts(UTIF.toRGBA8(page));
  },
  three: async () => {
    const {TIFFLoader} = await import('three/addons/loaders/TIFFLoader.js');
    return firsts(new TIFFLoader().parse(bytes.buffer).data);
  },
  tiff: async () => [...(await import('tiff')).decode(bytes)[0].data].slice(0, 4),
  geotiff: async () => {
    const image = await (await (await import('geotiff')).fromArrayBuffer(bytes.buffer)).getImage();
    return [...(await image.readRasters({interleave: true}))].slice(0, 4);
  },
};
try {
  console.log(...await readers[library]());
} catch (e) {
  console.log(e.message);
}
JS
read_with() { node read.mjs "$@" 2>&1 | tail -n 1; }
expect "three, plain" "$(read_with three plain.tif)" "0 128 255 63"
expect "utif2, plain" "$(read_with utif2 plain.tif)" "0 128 255 63"
packed=$(read_with utif2 apart.tif)
[[ $packed =~ ^[0-9]+\ [0-9]+\ [0-9]+\ [0-9]+$ && $packed != "0 127 255 "* ]] && packed="other values"
expect "utif2, predictor 3" "$packed" "other values"
expect "tiff, predictor 3" "$(read_with tiff apart.tif)" "invalid predictor: 3"
expect "geotiff, predictor 3" "$(read_with geotiff apart.tif)" "0 0.5 1 1.25"
finish

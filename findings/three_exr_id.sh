#!/usr/bin/env bash
# An id channel in an EXR file makes three's EXRLoader read colours from the wrong place.
#
# Version:   three 0.187.0 (npm)
# Guess:     channels other than R, G, B, A are skipped, whatever their type.
# Behaviour: channels of floats are skipped. One of unsigned integers counts as no bytes at all, so every channel whose name
#            sorts after it is read four bytes a pixel too early: with an ID beside them, red is the bits of the id, and
#            blue and green are right. No error is raised. (Babylon.js 9.31.0 does the same.)
# Matters:   render elements with object or material ids are often written into one file with the colour. The texture loses
#            its red, or, with compression, has its channels changed round; a name that sorts after R does no harm.
# Seen on 2026-11-27:
#   R 0.1, G 0.2, B 0.3: 0.1 0.2 0.3
#   the same and floats called ID: 0.1 0.2 0.3
#   the same and integers called ID: 0.0 0.2 0.3
#   the same and integers called Stone: 0.1 0.2 0.3
. "$(dirname "$0")/common/packages.bash"
node_packages three@0.187.0

python3 - <<'PY'
from pictures import write_exr
color = {n: (lambda x, y, v=v: v) for n, v in zip("RGB", (0.1, 0.2, 0.3))}
window = (0, 0, 3, 3)
write_exr("plain.exr", color, window, window)
write_exr("floats.exr", {**color, "ID": lambda x, y: 7.0}, window, window)
write_exr("integers.exr", {**color, "ID": lambda x, y: 7}, window, window, ["ID"])
write_exr("later.exr", {**color, "Stone": lambda x, y: 7}, window, window, ["Stone"])
PY
cat >read.mjs <<'JS'
import fs from 'fs';
import {FloatType} from 'three';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
const {data} = new EXRLoader().setDataType(FloatType).parse(new Uint8Array(fs.readFileSync(process.argv[2])).buffer);
console.log(...[...data.slice(0, 3)].map(v => v.toFixed(1)));
JS
read_with() { node read.mjs "$1" 2>&1 | tail -n 1; }
expect "R 0.1, G 0.2, B 0.3" "$(read_with plain.exr)" "0.1 0.2 0.3"
expect "the same and floats called ID" "$(read_with floats.exr)" "0.1 0.2 0.3"
expect "the same and integers called ID" "$(read_with integers.exr)" "0.0 0.2 0.3"
expect "the same and integers called Stone" "$(read_with later.exr)" "0.1 0.2 0.3"
finish

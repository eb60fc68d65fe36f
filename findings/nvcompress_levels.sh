#!/usr/bin/env bash
# nvcompress averages mip levels of all colours but normals through a gamma of 2.2, and has no option against it.
#
# Version:   libnvtt-bin 2.0.8-1+dfsg-8.2+b3 (Debian 12)
# Guess:     bytes are averaged as they are; colours would then be too dark in the distance, data maps right.
# Behaviour: the other way round. Squares of 0 and 255 give 186 in the first level, in the two channels of BC5 as well,
#            which no one uses for colours. Alpha (and BC4, which is made of it) is averaged as it is, and so is -normal.
# Matters:   a roughness map of 0 and 1 is 0.5 on average, but 0.73 from the first level on: surfaces turn dull as the
#            camera moves away. The way out is to make data maps' levels elsewhere.
# Seen on 2026-11-27:
#   first level of colours: 186
#   first level of red and green as BC5: 186 186
#   first level of alpha as BC4: 127
. "$(dirname "$0")/common/packages.bash"
debian libnvtt-bin=2.0.8-1+dfsg-8.2+b3

python3 - <<'PY'
from pictures import write_png
square = lambda x, y: (x + y) % 2 * 255
write_png("squares.png", [[(square(x, y),) * 4 for x in range(8)] for y in range(8)])
PY
run() { nvcompress "$@" squares.png out.dds >said 2>&1 || skip "nvcompress does not start"; }
byte() { python3 -c 'import sys; print(open("out.dds", "rb").read()[128 + int(sys.argv[1])])' "$1"; }
run -rgb
expect "first level of colours" "$(byte $((8 * 8 * 4)))" "186"
run -bc5
expect "first level of red and green as BC5" "$(byte $((4 * 16))) $(byte $((4 * 16 + 8)))" "186 186"
run -bc4
expect "first level of alpha as BC4" "$(byte $((4 * 8)))" "127"
finish

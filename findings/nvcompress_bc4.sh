#!/usr/bin/env bash
# nvcompress -bc4 keeps alpha, not red: a grey height map becomes white.
#
# Version:   libnvtt-bin 2.0.8-1+dfsg-8.2+b3 (Debian 12)
# Guess:     BC4, the format of one channel, is made of red, as in every engine's importer.
# Behaviour: it is made of alpha. A picture without alpha gives 255 in every block, without a word. -bc5 takes red and
#            green as expected.
# Matters:   BC4 is what roughness, height and occlusion are packed into. The file opens everywhere, and the surface is
#            evenly rough or flat at full height.
# Seen on 2026-11-27:
#   grey of 70: 255
#   red 50, alpha 200: 200
#   the same as BC5: 50 100
. "$(dirname "$0")/common/packages.bash"
debian libnvtt-bin=2.0.8-1+dfsg-8.2+b3

python3 - <<'PY'
from pictures import write_png
write_png("grey.png", [[(70,)] * 8] * 8)
write_png("color.png", [[(50, 100, 150, 200)] * 8] * 8)
PY
# A block of BC4 starts with its two end points; here both are the value of the whole block. BC5 is two such blocks.
block() {
  nvcompress -nomips "-$2" "$1.png" out.dds >said 2>&1 || skip "nvcompress does not start"
  python3 -c 'import sys; d = open("out.dds", "rb").read()[128:]; print(*[d[i] for i in range(0, int(sys.argv[1]), 8)])' "$3"
}
expect "grey of 70" "$(block grey bc4 8)" "255"
expect "red 50, alpha 200" "$(block color bc4 8)" "200"
expect "the same as BC5" "$(block color bc5 16)" "50 100"
finish

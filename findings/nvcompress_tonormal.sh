#!/usr/bin/env bash
# nvcompress -tonormal mirrors x: its normals are those of no convention.
#
# Version:   libnvtt-bin 2.0.8-1+dfsg-8.2+b3 (Debian 12)
# Guess:     normals with green up, or with green down; either can be set in an engine.
# Behaviour: red grows where the height grows to the right, so x has the wrong sign, while green is that of green up.
#            Read with green up, ridges along y are dents; read with green down, everything is a dent. Turning green over
#            never helps: red has to be turned over, once, before the file is used.
# Matters:   whoever turns heights into a DDS normal map with this tool checks the green channel, as everybody does, finds
#            it right, and gets a relief that is lit from the wrong side.
# Seen on 2026-11-27:
#   height grows to the right: 155 127 251
#   height grows downwards: 127 155 251
. "$(dirname "$0")/common/packages.bash"
debian libnvtt-bin=2.0.8-1+dfsg-8.2+b3

python3 - <<'PY'
from pictures import write_png
grey = lambda v: (v, v, v)
write_png("right.png", [[grey(40 + 2 * x) for x in range(64)] for y in range(64)])
write_png("down.png", [[grey(40 + 2 * y) for x in range(64)] for y in range(64)])
PY
for name in right down; do
  nvcompress -tonormal -nomips -rgb $name.png $name.dds >said 2>&1 || skip "nvcompress does not start"
done
# Uncompressed, 32 bits a pixel: blue, green, red, alpha behind 128 bytes of header.
pixel() {
  python3 -c 'import sys; b, g, r, a = open(sys.argv[1], "rb").read()[128 + 4 * (32 * 64 + 32):][:4]; print(r, g, b)' "$1"
}
expect "height grows to the right" "$(pixel right.dds)" "155 127 251"
expect "height grows downwards" "$(pixel down.dds)" "127 155 251"
finish

#!/usr/bin/env bash
# avifenc calls a linear PNG sRGB.
#
# Version:   libavif-bin 0.11.1-1+deb12u1 (Debian 12)
# Guess:     gAMA 1.0 becomes transfer characteristics 8, linear.
# Behaviour: the chunk is passed over. The numbers stay as they are and the file says 13, sRGB, as it does for a PNG without
#            any such chunk. --cicp 1/8/0 says it right by hand.
# Matters:   a linear base colour or emission is decoded once too often by every reader of AVIF and comes out dark. PNG's
#            16 bits become 12 besides, of which --lossless warns.
# Seen on 2026-11-27:
#   gAMA 1.0: 13
#   no gAMA: 13
#   gAMA 1.0, --cicp 1/8/0: 8
. "$(dirname "$0")/common/packages.bash"
debian libavif-bin=0.11.1-1+deb12u1

python3 - <<'PY'
import struct
import zlib
from pictures import write_png
write_png("plain.png", [[(128, 64, 32)] * 16] * 16)
plain = open("plain.png", "rb").read()
gamma = b"gAMA" + struct.pack(">I", 100000)
with open("gamma.png", "wb") as out:
    out.write(plain[:33] + struct.pack(">I", 4) + gamma + struct.pack(">I", zlib.crc32(gamma)) + plain[33:])
PY
transfer() {
  local file=$1
  shift
  avifenc -s 10 -j 1 "$@" "$file" out.avif >said 2>&1 || skip "avifenc does not run: $(tail -n 1 said)"
  avifdec --info out.avif | sed -n 's/.*Transfer Char[^:]*: *//p'
}
expect "gAMA 1.0" "$(transfer gamma.png)" "13"
expect "no gAMA" "$(transfer plain.png)" "13"
expect "gAMA 1.0, --cicp 1/8/0" "$(transfer gamma.png --cicp 1/8/0)" "8"
finish

#!/usr/bin/env bash
# netpbm scales data maps through the curve of BT.709: a level of 0 and 255 is 179, not 128.
#
# Version:   netpbm 2:11.01.00-2 (Debian 12)
# Guess:     pamscale, like most scalers without an option, averages the numbers as they are: 128.
# Behaviour: PGM and PPM are light encoded as BT.709 has it. Numbers are decoded, averaged and encoded again, which gives
#            179: neither 128 nor the 188 of sRGB. pamscale -linear gives 128, and so does pamstretch at a seam.
# Matters:   roughness and masks that are halved in a pipeline of PNM tools come out brighter wherever they vary, and
#            colours differ from those of every tool that takes the bytes for sRGB.
# Seen on 2026-11-27:
#   squares of 0 and 255, halved: 179
#   with -linear: 128
#   16 bits, squares of 0 and 65535, halved: 46070
. "$(dirname "$0")/common/packages.bash"
debian netpbm=2:11.01.00-2

printf 'P2 2 2 255\n0 255\n255 0\n' | pamtopnm >squares.pgm || skip "netpbm does not start"
printf 'P2 2 2 65535\n0 65535\n65535 0\n' | pamtopnm >squares16.pgm
scaled() { pamscale -xysize 1 1 "$@" | pamtopnm -plain | tail -n 1 | tr -d ' '; }
expect "squares of 0 and 255, halved" "$(scaled squares.pgm)" "179"
expect "with -linear" "$(scaled -linear squares.pgm)" "128"
expect "16 bits, squares of 0 and 65535, halved" "$(scaled squares16.pgm)" "46070"
finish

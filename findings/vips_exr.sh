#!/usr/bin/env bash
# libvips rounds EXR floats to halves, and calls them float.
#
# Version:   libvips-tools 8.14.1-3+deb12u3 (Debian 12)
# Guess:     floats stay what they are, a single channel stays a single channel, and one without R, G, B, Y is an error.
# Behaviour: every file comes as four bands of "float" that hold no more than halves. Heights near 1 move in steps of
#            1/1024, and what has no channel R, G, B or Y is black, without a word. Alpha, where there is none, is 255,
#            beside colours of 0 to 1.
# Matters:   a displacement map that a script only crops or converts with vips has steps afterwards, though the type before
#            and after is float; a depth channel Z or a map called roughness is lost.
# Seen on 2026-11-27:
#   bands: 8x8 float, 4 bands, scrgb, openexrload
#   R 1.0007, G 0.2, B 0.3: 1.00098 0.199951 0.300049 255
#   Y 1.0007: 1.00098 1.00098 1.00098 255
#   Z 0.7: 0 0 0 255
. "$(dirname "$0")/common/packages.bash"
debian libvips-tools=8.14.1-3+deb12u3

python3 - <<'PY'
from pictures import write_exr
values = {"R": 1.0007, "G": 0.2, "B": 0.3, "Y": 1.0007, "Z": 0.7}
window = (0, 0, 7, 7)
for names in ("RGB", "Y", "Z"):
    write_exr(names + ".exr", {n: (lambda x, y, n=n: values[n]) for n in names}, window, window)
PY
header=$(vipsheader RGB.exr 2>error) || skip "vips does not read EXR: $(tail -n 1 error)"
at() { vips getpoint "$1" 3 3 | sed 's/ *$//'; }
expect "bands" "${header#*: }" "8x8 float, 4 bands, scrgb, openexrload"
expect "R 1.0007, G 0.2, B 0.3" "$(at RGB.exr)" "1.00098 0.199951 0.300049 255"
expect "Y 1.0007" "$(at Y.exr)" "1.00098 1.00098 1.00098 255"
expect "Z 0.7" "$(at Z.exr)" "0 0 0 255"
finish

#!/usr/bin/env bash
# GEGL's normal-map, the filter behind GIMP's Normal Map, writes green down.
#
# Version:   gegl 1:0.4.42-2+deb12u2 (Debian 12)
# Guess:     green up, as Blender, glTF and most free tools have it, with "flip-y" for the others.
# Behaviour: the default is green down, as DirectX has it; flip-y=true gives green up. The description of the option says
#            neither. (The slopes come from the bytes as they are, not from linear light: that was guessed rightly.)
# Matters:   a map made with the free program and loaded into free renderers is lit from below. The picture looks like any
#            other normal map, so the error is found late.
# Seen on 2026-11-27:
#   height grows to the right: red below the middle, green in the middle
#   height grows downwards: red in the middle, green below the middle
#   the same with flip-y: red in the middle, green above the middle
. "$(dirname "$0")/common/packages.bash"
debian gegl=1:0.4.42-2+deb12u2
plugins=$(find "$dir/root" -type d -name 'gegl-0.4' -path '*/lib/*' | head -n 1)
[ -z "$plugins" ] || export GEGL_PATH=$plugins
spaces=$(find "$dir/root" -type d -name 'babl-0.1' -path '*/lib/*' | head -n 1)
[ -z "$spaces" ] || export BABL_PATH=$spaces

python3 - <<'PY'
from pictures import write_png
write_png("right.png", [[(40 + 2 * x,) for x in range(64)] for y in range(64)])
write_png("down.png", [[(40 + 2 * y,) for x in range(64)] for y in range(64)])
PY
look() {
  gegl "$1.png" -o out.png -- normal-map ${2:-} >said 2>&1 && [ -s out.png ] || skip "gegl does not run: $(tail -n 1 said)"
  python3 - <<'PY'
from pictures import read_png
rows, bits = read_png("out.png")
side = lambda v: "below the middle" if v < 0.49 else "above the middle" if v > 0.51 else "in the middle"
red, green = (v / (2**bits - 1) for v in rows[32][32][:2])
print(f"red {side(red)}, green {side(green)}")
PY
}
expect "height grows to the right" "$(look right)" "red below the middle, green in the middle"
expect "height grows downwards" "$(look down)" "red in the middle, green below the middle"
expect "the same with flip-y" "$(look down flip-y=true)" "red in the middle, green above the middle"
finish

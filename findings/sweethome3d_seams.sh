#!/usr/bin/env bash
# Of the surfaces that Sweet Home 3D repeats over walls and floors, one in five does not go on from border to border.
#
# Version:   sweethome3d 7.0.2+dfsg-3, python3-pil 9.4.0-1.1+deb12u1 (Debian 12)
# Guess:     stock textures that a program lays side by side tile: what changes from the last row to the first is no more
#            than what changes somewhere between two rows inside.
# Behaviour: of 23 (its skies left out) five have a seam that is stronger than any step inside, all of them between rows:
#            chequered tiles by twice as much, three kinds of tiles and a herringbone.
# Matters:   who tells from its borders whether a texture tiles must let a joint along the border be stronger than any
#            inside, or takes tiles for a photograph that was cut out and tears them.
# Seen on 2026-11-28:
#   surfaces: 23
#   seams stronger than any step inside: blackAndWhiteTiles 2.2, lightBlueTile 1.4, redTiles 1.0, wallBeigeTile 1.2, woodenFloor 1.1
. "$(dirname "$0")/common/packages.bash"
debian python3-pil=9.4.0-1.1+deb12u1
apt-get download -qq sweethome3d=7.0.2+dfsg-3 >apt.log 2>&1 || skip "no sweethome3d among Debian's packages"
mkdir home
dpkg -x sweethome3d_*.deb home || skip "its package cannot be unpacked"

cat >seams.py <<'P'
import io, zipfile
from PIL import Image

def apart(a, b):
    return sum(abs(p - q) for s, t in zip(a, b) for p, q in zip(s, t)) / len(a)

def seam_over_inside(picture, rows):
    """The mean change across the border, by the largest between two neighbouring lines."""
    width, height = picture.size
    pixels = list(picture.getdata())
    lines = [pixels[y * width:(y + 1) * width] for y in range(height)] if rows else [pixels[x::width] for x in range(width)]
    return apart(lines[-1], lines[0]) / max(apart(a, b) for a, b in zip(lines, lines[1:]))

jar = zipfile.ZipFile("home/usr/share/sweethome3d/sweethome3d.jar")
folder = "com/eteks/sweethome3d/io/resources/textures/"
names = sorted(n[len(folder):-4] for n in jar.namelist() if n.startswith(folder) and n.endswith(".jpg"))
surfaces = [n for n in names if "sky" not in n.lower() and "cloudy" not in n.lower()]
print(len(surfaces))
found = []
for name in surfaces:
    picture = Image.open(io.BytesIO(jar.read(f"{folder}{name}.jpg"))).convert("RGB")
    worst = max(seam_over_inside(picture, rows) for rows in (True, False))
    if worst > 1:
        found.append(f"{name} {worst:.1f}")
print(", ".join(found))
P
PYTHONPATH=$(find "$dir/root" -type d -path '*/dist-packages' 2>/dev/null | paste -sd:) \
  /usr/bin/python3 seams.py >seen.txt || skip "Python does not read the pictures"
expect "surfaces" "$(sed -n 1p seen.txt)" "23"
expect "seams stronger than any step inside" "$(sed -n 2p seen.txt)" \
  "blackAndWhiteTiles 2.2, lightBlueTile 1.4, redTiles 1.0, wallBeigeTile 1.2, woodenFloor 1.1"
finish

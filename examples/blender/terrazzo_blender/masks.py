# Masks from faces: triangles in UV space drawn into a picture, and the PNG file. Plain Python and NumPy.
import struct
import zlib

import numpy


def draw(uvs, values, size, margin=2):
    """uvs: (n, 3, 2) triangles, values: (n, 3) from 0 to 1 at their corners. An array (height, width), the top row first,
    black where there is no triangle. Drawn triangles grow by `margin` pixels into the black, so that seams are covered;
    they wrap, as UVs outside of the unit square show the same maps."""
    width, height = size
    out = numpy.zeros((height, width))
    drawn = numpy.zeros((height, width), bool)
    for corners, at_corners in zip(numpy.asarray(uvs, float), numpy.asarray(values, float)):
        draw_triangle(out, drawn, corners * (width, -height) + (0, height), at_corners)
    for _ in range(margin):
        grow(out, drawn)
    return out


def draw_triangle(out, drawn, corners, values):
    height, width = out.shape
    low = numpy.floor(corners.min(axis=0)).astype(int)
    high = numpy.ceil(corners.max(axis=0)).astype(int)
    # The same triangle covers no pixel twice, however large.
    high = numpy.minimum(high, low + (width * 4, height * 4))
    x, y = numpy.meshgrid(numpy.arange(low[0], high[0]), numpy.arange(low[1], high[1]))
    a, b, c = corners
    area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    if abs(area) < 1e-12 or x.size == 0:
        return
    px, py = x + 0.5, y + 0.5
    second = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / area
    third = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / area
    inside = (second >= -1e-9) & (third >= -1e-9) & (second + third <= 1 + 1e-9)
    value = values[0] + second * (values[1] - values[0]) + third * (values[2] - values[0])
    rows, columns = y[inside] % height, x[inside] % width
    # Where UVs overlap, white counts.
    numpy.maximum.at(out, (rows, columns), value[inside].clip(0, 1))
    drawn[rows, columns] = True


def grow(out, drawn):
    """Pixels beside drawn ones get their greatest value."""
    around = [(0, 1), (0, -1), (1, 0), (-1, 0)]
    near = numpy.max([numpy.roll(numpy.where(drawn, out, 0), s, axis=(0, 1)) for s in around], axis=0)
    beside = numpy.any([numpy.roll(drawn, s, axis=(0, 1)) for s in around], axis=0) & ~drawn
    out[beside] = near[beside]
    drawn |= beside


def write_png(path, values):
    """A grey picture of 8 bits from values of 0 to 1."""
    rows = numpy.round(numpy.clip(values, 0, 1) * 255).astype(numpy.uint8)
    height, width = rows.shape
    filtered = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), rows], axis=1).tobytes()

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(filtered)) + chunk(b"IEND", b""))

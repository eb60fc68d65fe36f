# Repacks a uv map for Blender, which keeps 16-bit images at 8 bytes a pixel or more: from the TIFF file that the program
# writes (x in red, y in green) to an 8-bit PNG with the high and the low byte of x and of y, at 4. Plain Python and NumPy.
import struct
import zlib

import numpy

WIDTH, HEIGHT, COMPRESSION, STRIPS, CHANNELS, ROWS, BYTES, PREDICTOR = 256, 257, 259, 273, 277, 278, 279, 317
SIZES = {3: ("H", 2), 4: ("I", 4)}
DEFLATE, DIFFERENCES = 8, 2


def tags_of(data):
    """The numbers in the directory of a TIFF file, by tag."""
    if data[:4] != b"II*\0":
        raise ValueError("it is no little-endian TIFF file")
    at, = struct.unpack_from("<I", data, 4)
    count, = struct.unpack_from("<H", data, at)
    out = {}
    for entry in range(at + 2, at + 2 + 12 * count, 12):
        tag, kind, number = struct.unpack_from("<HHI", data, entry)
        if kind not in SIZES:
            continue
        letter, size = SIZES[kind]
        place = entry + 8 if number * size <= 4 else struct.unpack_from("<I", data, entry + 8)[0]
        out[tag] = struct.unpack_from(f"<{number}{letter}", data, place)
    return out


def strips_of(data):
    """Rows of a uv map, strip by strip: arrays (rows, width, channels) of 16 bits."""
    tags = tags_of(data)
    width, channels = tags[WIDTH][0], tags[CHANNELS][0]
    if tags[COMPRESSION][0] != DEFLATE or tags[PREDICTOR][0] != DIFFERENCES:
        raise ValueError("it is not compressed as the program does it")
    for start, size in zip(tags[STRIPS], tags[BYTES]):
        rows = numpy.frombuffer(zlib.decompress(data[start:start + size]), "<u2").reshape(-1, width, channels)
        yield numpy.cumsum(rows, axis=1, dtype=numpy.uint16)


def repack(tiff, png):
    """Writes the PNG file. Raises ValueError with a sentence if the TIFF file is not as the program writes it."""
    with open(tiff, "rb") as file:
        data = file.read()
    compressor, parts = zlib.compressobj(1), []
    try:
        tags = tags_of(data)
        for rows in strips_of(data):
            pixels = rows[:, :, :2].astype(">u2").view(numpy.uint8)
            filtered = pixels.copy()
            filtered[:, 1:] -= pixels[:, :-1]
            lines = filtered.reshape(len(rows), -1)
            parts.append(compressor.compress(numpy.insert(lines, 0, 1, axis=1).tobytes()))
    except (KeyError, ValueError, struct.error, zlib.error) as e:
        raise ValueError(f"The uv map {tiff} cannot be read: {e}.")
    parts.append(compressor.flush())

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", tags[WIDTH][0], tags[HEIGHT][0], 8, 6, 0, 0, 0)
    with open(png, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                   b"".join(chunk(b"IDAT", p) for p in parts if p) + chunk(b"IEND", b""))

"""Writes and reads small pictures with Python's own library alone. Rows are lists of pixels, pixels tuples of channels."""

import struct
import zlib


def write_png(path, rows, bits=8):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, channels = len(rows), len(rows[0]), len(rows[0][0])
    code = ">" + ("B" if bits == 8 else "H") * channels
    raw = b"".join(b"\0" + b"".join(struct.pack(code, *pixel) for pixel in row) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, bits, {1: 0, 2: 4, 3: 2, 4: 6}[channels], 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def read_png(path):
    """Rows of pixels as stored, and the bits of a channel. Not interlaced, no palette."""
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    step = channels * bits // 8
    raw, before, rows = zlib.decompress(packed), bytearray(width * step), []
    for y in range(height):
        start = y * (width * step + 1)
        kind, line = raw[start], bytearray(raw[start + 1 : start + 1 + width * step])
        for i in range(len(line)):
            left = line[i - step] if i >= step else 0
            corner = before[i - step] if i >= step else 0
            up = before[i]
            near = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, near)[kind]) & 255
        before = line
        values = struct.unpack(">%d%s" % (width * channels, "B" if bits == 8 else "H"), bytes(line))
        rows.append([values[i : i + channels] for i in range(0, len(values), channels)])
    return rows, bits


def write_exr(path, channels, data_window, display_window, integers=()):
    """Without compression. `channels`: names and functions of x and y. Windows: x, y, last x, last y.

    32-bit floats; the channels in `integers` are unsigned integers."""

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    names = sorted(channels)
    kind = lambda name: 0 if name in integers else 2
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", kind(name), 0, 1, 1) for name in names) + b"\0"
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", listed)
    header += attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", struct.pack("<4i", *data_window))
    header += attribute("displayWindow", "box2i", struct.pack("<4i", *display_window))
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    left, top, right, bottom = data_window
    width, height = right - left + 1, bottom - top + 1
    lines = []
    for y in range(top, bottom + 1):
        line = b""
        for name in names:
            values = [channels[name](x, y) for x in range(left, right + 1)]
            line += struct.pack("<%d%s" % (width, "I" if name in integers else "f"), *values)
        lines.append(struct.pack("<ii", y, len(line)) + line)
    at, table = len(header) + 8 * height, b""
    for line in lines:
        table += struct.pack("<Q", at)
        at += len(line)
    with open(path, "wb") as out:
        out.write(header + table + b"".join(lines))


def write_tiff(path, rows, floats_apart=False, halves=False):
    """32-bit floats, or 16-bit. `floats_apart`: packed with the predictor for 32-bit floats (3), as OpenImageIO does."""
    height, width, channels = len(rows), len(rows[0]), len(rows[0][0])
    lines = []
    for row in rows:
        values = [v for pixel in row for v in pixel]
        if floats_apart:
            whole = struct.pack(">%df" % len(values), *values)
            planes = b"".join(whole[i::4] for i in range(4))
            lines.append(bytes((v - (planes[i - channels] if i >= channels else 0)) & 255 for i, v in enumerate(planes)))
        else:
            lines.append(struct.pack("<%d%s" % (len(values), "e" if halves else "f"), *values))
    data = b"".join(lines)
    if floats_apart:
        data = zlib.compress(data)
    body = bytearray(data + b"\0" * (len(data) % 2))

    def tag(number, kind, values):
        code = {3: "H", 4: "I"}[kind]
        packed = struct.pack("<%d%s" % (len(values), code), *values)
        if len(packed) > 4:
            packed, at = struct.pack("<I", 8 + len(body)), packed
            body.extend(at + b"\0" * (len(at) % 2))
        return struct.pack("<HHI", number, kind, len(values)) + packed.ljust(4, b"\0")

    tags = [tag(256, 4, [width]), tag(257, 4, [height]), tag(258, 3, [16 if halves else 32] * channels)]
    tags += [tag(259, 3, [8 if floats_apart else 1]), tag(262, 3, [2 if channels > 2 else 1]), tag(273, 4, [8])]
    tags += [tag(277, 3, [channels]), tag(278, 4, [height]), tag(279, 4, [len(data)])]
    tags += [tag(317, 3, [3])] if floats_apart else []
    tags += [tag(339, 3, [3] * channels)]
    with open(path, "wb") as out:
        out.write(struct.pack("<2sHI", b"II", 42, 8 + len(body)) + body)
        out.write(struct.pack("<H", len(tags)) + b"".join(tags) + bytes(4))

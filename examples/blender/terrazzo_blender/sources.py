# Makes a folder of maps for the program from the images of a material. Files are linked or copied as they are; Blender
# never rewrites one. Plain Python.
import json
import os
import shutil

SPACES = {"sRGB": "srgb_texture", "Linear": "lin_rec709", "Linear Rec.709": "lin_rec709", "Non-Color": "raw", "Raw": "raw",
          "Linear ACEScg": "ACEScg", "ACEScg": "ACEScg"}
COLORS = ("base_color", "emission")
MAGIC = ((b"\x89PNG", ".png"), (b"\xff\xd8\xff", ".jpg"), (b"\x76\x2f\x31\x01", ".exr"), (b"II*\0", ".tif"),
         (b"MM\0*", ".tif"), (b"#?RA", ".hdr"), (b"RIFF", ".webp"), (b"BM", ".bmp"), (b"SDPX", ".dpx"), (b"XPDS", ".dpx"))


class SourceError(Exception):
    """An image cannot be used; the message says why, and what to do."""


class File:
    """What the program gets of an image: a file, or the bytes of a packed one; of a UDIM set, one tile."""

    def __init__(self, image, path, tile):
        """path: the image's file, without Blender's //. tile: a number such as 1001."""
        packed, self.path = image.packed_file, path
        if image.source == "TILED":
            column, row = (tile - 1001) % 10 + 1, (tile - 1001) // 10 + 1
            self.path = path.replace("<UDIM>", str(tile)).replace("<UVTILE>", f"u{column}_v{row}")
            packed = next((p.packed_file for p in image.packed_files if p.tile_number == tile), None)
        self.image, self.data = image, None if packed is None else bytes(packed.data)

    def problem(self):
        """Why the program cannot read it, or nothing."""
        return problem_of(self.image, self.path, self.data is not None)

    def ending(self):
        """The ending of the file's name, of a packed one by its content."""
        ending = os.path.splitext(self.path)[1].lower()
        if self.data is None:
            return ending
        return next((e for magic, e in MAGIC if self.data.startswith(magic)), ending or ".tga")

    def place(self, target):
        """Puts it at a place: the packed bytes, a link, or a copy where there are no links."""
        if self.data is not None:
            if not os.path.isfile(target) or open(target, "rb").read() != self.data:
                with open(target, "wb") as file:
                    file.write(self.data)
            return
        if os.path.lexists(target):
            os.remove(target)
        try:
            os.symlink(os.path.abspath(self.path), target)
        except OSError:
            shutil.copyfile(self.path, target)


def problem_of(image, path, is_packed):
    name = f"The image '{image.name}'"
    if image.source in ("SEQUENCE", "MOVIE"):
        return f"{name} is a {image.source.lower()}; only single images are taken."
    if image.is_dirty:
        return f"{name} has changes that are not saved. Save it (Image > Save) or pack it first."
    if is_packed:
        return ""
    if image.source == "GENERATED":
        return f"{name} is generated and has no file. Save it (Image > Save As) or pack it first."
    if image.source not in ("FILE", "TILED"):
        return f"{name} is of the kind {image.source}, which has no file."
    if not os.path.isfile(path):
        return f"{name} is missing: there is no file {path}. File > External Data > Find Missing Files may find it."
    return ""


def channels_of(data):
    """How many channels a PNG or JPEG file's pixels have, from its first bytes; 0 if it is another format."""
    if data.startswith(b"\x89PNG") and len(data) > 25:
        return {0: 1, 2: 3, 3: 3, 4: 2, 6: 4}.get(data[25], 0)
    at = 2
    while data.startswith(b"\xff\xd8") and at + 9 < len(data) and data[at] == 0xff:
        if 0xc0 <= data[at + 1] <= 0xcf and data[at + 1] not in (0xc4, 0xc8, 0xcc):
            return data[at + 9]
        at += 2 + int.from_bytes(data[at + 2:at + 4], "big")
    return 0


def gather(maps, folder, path_of, name, metres=None):
    """Makes the folder: files named after their maps, and a description. maps: of tree.Picked. path_of(image): its
    file. metres: the physical width and height, if they are known. Of UDIM sets it takes one tile: the active one of the
    first set. Returns notes; raises SourceError."""
    tiled = next((u.image for u in maps.values() if u.image.source == "TILED"), None)
    tile = tiled.tiles.active.number if tiled is not None else 1001
    sources = {use.image: File(use.image, path_of(use.image), tile) for use in maps.values()}
    problems = [p for p in (s.problem() for s in sources.values()) if p]
    if problems:
        raise SourceError(" ".join(problems))
    os.makedirs(folder, exist_ok=True)
    files, names, notes = {}, {}, []
    if tiled is not None:
        notes.append(f"Tile {tile} of the UDIM set is taken: the active one of '{tiled.name}' (Image Editor > Sidebar > Image "
                     "> UDIM Tiles).")
    for map, use in maps.items():
        image = use.image
        if image not in names:
            names[image] = map + sources[image].ending()
            sources[image].place(os.path.join(folder, names[image]))
        entry = files.setdefault(names[image], {"maps": {}})
        is_color = map in COLORS
        entry["maps"][map] = use.channel or whole(map, os.path.join(folder, names[image]))
        if use.inverted:
            entry.setdefault("inverted", []).append(map)
        if map == "normal":
            entry["normal_y"] = "down" if use.normal_down else "up"
        space = image.colorspace_settings.name
        if is_color:
            if space not in SPACES:
                notes.append(f"{image.name}: the colour space {space} is read as sRGB.")
            color_space = SPACES.get(space, "srgb_texture")
            entry["color_space"] = "lin_rec709" if color_space == "raw" else color_space
        else:
            entry.setdefault("color_space", "raw")
            if space not in ("Non-Color", "Raw") and use.channel != "a":
                notes.append(f"{image.name} holds {map} but is marked {space}; it is read as data, and the new material "
                             "shows it as such.")
    description = {"terrazzo_material": 1, "name": name}
    if metres:
        description["metres"] = list(metres)
    with open(os.path.join(folder, "terrazzo-material.json"), "w", encoding="utf-8") as file:
        json.dump({**description, "files": files}, file, indent=2)
    keep = set(files) | {"terrazzo-material.json"}
    for old in os.listdir(folder):
        if old not in keep:
            os.remove(os.path.join(folder, old))
    return notes


def whole(map, file):
    """The channels of a map that takes the whole file."""
    if map not in COLORS and map != "normal":
        return "r"
    with open(file, "rb") as opened:
        return "r" if channels_of(opened.read(1 << 18)) in (1, 2) else "rgb"

# Which maps a run has written, from the description that the program writes beside them, or from the files' names.
# Plain Python.
import json
import os

NAMES = ("base_color", "normal", "height", "roughness", "metallic", "ambient_occlusion", "opacity", "emission")
COLORS = ("base_color", "emission")
SIDECAR = "terrazzo-material.json"
LINEAR_ENDINGS = (".exr", ".hdr")


class Result:
    def __init__(self, folder, name, files, metres):
        self.folder, self.name, self.files, self.metres = folder, name, files, metres


def color_space_of(map, file, said=""):
    """Blender's name for the colour space; "Linear" for linear colours, whose name differs by version."""
    if map not in COLORS:
        return "Non-Color"
    if said:
        return {"srgb_texture": "sRGB", "raw": "Non-Color"}.get(said, "Linear")
    return "Linear" if file.lower().endswith(LINEAR_ENDINGS) else "sRGB"


def read(folder):
    """The result in a folder that has a description. Raises ValueError with a sentence."""
    path = os.path.join(folder, SIDECAR)
    try:
        with open(path, encoding="utf-8") as opened:
            description = json.load(opened)
        files = {}
        for file, entry in description["files"].items():
            for map, channels in entry["maps"].items():
                if map not in NAMES:
                    continue
                files[map] = {"file": file, "color_space": color_space_of(map, file, entry.get("color_space", ""))}
                if len(channels) == 1 and len(entry["maps"]) > 1:
                    files[map]["channel"] = channels
                if map in entry.get("inverted", []):
                    files[map]["inverted"] = True
                if map == "normal" and entry.get("normal_y") == "down":
                    files[map]["normal_y"] = "down"
        return Result(folder, description.get("name", "material"), files, description.get("metres"))
    except OSError as e:
        raise ValueError(f"There is no result in {folder}: {path}: {e.strerror}.")
    except (ValueError, KeyError, AttributeError, TypeError) as e:
        raise ValueError(f"{path} cannot be read: {e}.")


def from_files(paths):
    """The result among the files that a run has written. Raises ValueError with a sentence."""
    described = next((p for p in paths if os.path.basename(p) == SIDECAR), None)
    if described:
        return read(os.path.dirname(described))
    folders = {}
    for path in paths:
        stem = os.path.splitext(os.path.basename(path))[0].lower()
        map = next((n for n in NAMES if stem == n or stem.endswith(("_" + n, "-" + n))), None)
        if map:
            file = os.path.basename(path)
            folders.setdefault(os.path.dirname(path), {}).setdefault(
                map, {"file": file, "color_space": color_space_of(map, file)})
    if not folders:
        raise ValueError("The graph has written no maps: end it in an export_preset node, or in an export node whose path "
                         "contains {map}.")
    folder = max(folders, key=lambda f: len(folders[f]))
    return Result(folder, os.path.basename(folder) or "material", folders[folder], None)

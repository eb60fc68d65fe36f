#!/usr/bin/env python3
"""A node in Python: wears off what stands out, in every map of a material. examples/python/wear.py OUT"""

import pathlib
import sys

import numpy as np

import terrazzo as tz


@tz.node(version=1)
def wear(material: tz.Material, amount: float = 0.3, grey: float = 0.6) -> tz.Material:
    """Wears off what stands out

    Cuts heights at a quantile, and bleaches colours there."""
    height = material["height"].numpy()
    top = np.quantile(height, 1 - amount)
    worn = np.clip((height - top) / max(float(height.max()) - top, 1e-6), 0, 1)
    tz.note(f"{np.mean(worn > 0):.0%} of the surface is worn")
    maps = {}
    for name, image in material.items():
        pixels = image.numpy()
        if name == "height":
            maps[name] = tz.Image.from_numpy(np.minimum(pixels, top), semantic="height")
        elif name == "base_color":
            bleached = pixels + worn[..., None] * (grey - pixels) * 0.5
            maps[name] = tz.Image.from_numpy(bleached, semantic="base_color", color_space=image.color_space)
        else:
            maps[name] = image
    return tz.Material(material.name, maps)


GRAPH = """{
  "terrazzo": 1,
  "parameters": {"amount": {"type": "number", "default": 0.3}, "out": {"type": "path"}},
  "nodes": {
    "wall":  {"type": "pattern", "kind": "bricks", "size": [256, 256]},
    "worn":  {"type": "wear", "material": "@wall", "amount": "$amount"},
    "files": {"type": "export", "material": "@worn", "path": "$out/{map}.png", "depth": "uint16"}
  }
}
"""


def main():
    graph = tz.Graph.loads(GRAPH)
    graph.params["out"] = pathlib.Path(sys.argv[1])
    with tz.Session() as session:
        result = session.run(graph)
    print(result.summary, *result.notes, sep="\n")


if __name__ == "__main__":
    main()

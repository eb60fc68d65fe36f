#!/usr/bin/env python3
"""Many arrangements of one material: a table of figures, and a contact sheet. examples/python/sweep.py OUT [EXEMPLAR]"""

import csv
import pathlib
import sys

import numpy as np

import terrazzo as tz


def make_exemplar(session, folder):
    graph = tz.Graph.stock("generate-exemplar")
    graph.params.update(type="cobbles", size=(96, 96), out=folder)
    session.run(graph, only="files")
    return folder


def sheet_of(pictures, columns):
    """Pictures side by side, with a black border."""
    framed = [np.pad(p, ((2, 2), (2, 2), (0, 0))) for p in pictures]
    rows = [np.concatenate(framed[i : i + columns], axis=1) for i in range(0, len(framed), columns)]
    return np.concatenate(rows)


def main():
    out = pathlib.Path(sys.argv[1])
    with tz.Session() as session:
        exemplar = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else make_exemplar(session, out / "exemplar")
        graph = tz.Graph.stock("material")
        graph.params.update(material=exemplar, size=(128, 128), quality="draft")
        table, pictures = [], []
        for variation in session.sweep(graph, seed=range(1, 4), blend=[0, 2]):
            material = variation["result"]
            height = material["height"].numpy()
            table.append({**variation.values, "mean height": float(height.mean()), "rough": float(height.std())})
            pictures.append(material["base_color"].numpy())
        out.mkdir(parents=True, exist_ok=True)
        with open(out / "table.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, table[0].keys())
            writer.writeheader()
            writer.writerows(table)
        sheet = tz.Image.from_numpy(sheet_of(pictures, columns=2), "base_color", color_space="srgb_texture")
        tz.export(sheet, out / "sheet.png", session=session, depth="uint8")
        roughest = max(table, key=lambda row: row["rough"])
    print(f"{len(table)} variations; the roughest has seed {roughest['seed']} and blend {roughest['blend']}")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Makes a larger material of each folder of maps in a folder, and tells which could not be made.

examples/python/batch.py OUT [--materials FOLDER] [--size 1024x1024]; without materials it makes twenty small ones first.
"""

import argparse
import pathlib
import sys

import terrazzo as tz

KINDS = ["bricks", "cobbles", "planks", "gravel"]


def make_exemplars(session, folder):
    """Twenty materials to play with."""
    graph = tz.Graph.stock("generate-exemplar")
    for i in range(20):
        graph.params.update(type=KINDS[i % 4], size=(64, 64), seed=i, out=folder / f"{KINDS[i % 4]}-{i}")
        session.run(graph, only="files")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--materials", type=pathlib.Path)
    parser.add_argument("--size", default="128x128")
    args = parser.parse_args()

    graph = tz.Graph.stock("material")
    graph.params.update(size=args.size, quality="draft")
    failed = []
    with tz.Session() as session:
        if args.materials is None:
            args.materials = args.out / "exemplars"
            make_exemplars(session, args.materials)
        folders = sorted(f for f in args.materials.iterdir() if f.is_dir())
        for i, folder in enumerate(folders, 1):
            graph.params.update(material=folder, out=args.out / "made" / folder.name)
            try:
                result = session.run(graph)
                print(f"{i}/{len(folders)} {folder.name}: {len(result.files)} files, {result.summary}")
            except (tz.GraphError, tz.RunError) as error:
                failed.append(folder.name)
                print(f"{i}/{len(folders)} {folder.name}: {error}", file=sys.stderr)
    print(f"{len(folders) - len(failed)} made, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

# Graph files: those of one's own, stock graphs, and the panel's settings as a file.
import json
import os
import subprocess

import bpy

from . import command, graph_file, program, settings as panel
from .preferences import preferences

STOCK = "stock:"


def path_of(settings):
    """The graph as the program takes it: a file, or stock:NAME. Raises GraphError."""
    if not settings.graph:
        raise graph_file.GraphError("Choose a graph file, or stock:NAME.")
    return settings.graph if settings.graph.startswith(STOCK) else bpy.path.abspath(settings.graph)


def read_into(settings):
    """Makes fields of the graph's exposed parameters. Raises GraphError or ProgramError."""
    path = path_of(settings)
    if path.startswith(STOCK):
        target = os.path.join(bpy.app.tempdir, path.replace(":", "-") + ".json")
        format_into(path, target)
        path = target
    panel.fill_parameters(settings, graph_file.read(path), path)


def format_into(graph, target):
    """Writes a stock graph or a graph file as a file in the usual layout. Raises GraphError or ProgramError."""
    try:
        asked = subprocess.run([program.find(preferences().program), "format", graph, "-o", target, "--force"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=20)
    except (OSError, subprocess.TimeoutExpired) as e:
        raise program.ProgramError(f"The program cannot be run: {e}")
    if asked.returncode != 0:
        raise graph_file.GraphError(asked.stdout.decode("utf-8", "replace").strip())


def write_own(values, path):
    """Writes the graph that the panel runs, with the panel's values as defaults."""
    with open(command.GRAPH, encoding="utf-8") as file:
        document = json.load(file)
    for name, value in values.items():
        document["parameters"][name]["default"] = value
    draft = os.path.join(bpy.app.tempdir, "draft.json")
    with open(draft, "w", encoding="utf-8") as file:
        json.dump(document, file)
    format_into(draft, path)

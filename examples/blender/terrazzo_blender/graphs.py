# Graph files: those of one's own, stock graphs, and the panel's settings as a file.
import json
import os
import subprocess

import bpy

from . import graph_file, program, settings as panel
from .preferences import preferences

STOCK = "stock:"


def path_of(settings):
    """The graph as the program takes it: a file, or stock:NAME. Raises GraphError."""
    if not settings.graph:
        raise graph_file.GraphError("Choose a graph file, or stock:NAME.")
    return settings.graph if settings.graph.startswith(STOCK) else bpy.path.abspath(settings.graph)


def read_into(settings):
    """Makes fields of the graph's exposed parameters. Raises GraphError or ProgramError."""
    path = file_of(path_of(settings))
    panel.fill_parameters(settings, graph_file.read(path), path)


def file_of(graph):
    """A graph as a file: a stock graph is written to Blender's folder for temporary files."""
    if not graph.startswith(STOCK):
        return graph
    target = os.path.join(bpy.app.tempdir, graph.replace(":", "-") + ".json")
    format_into(graph, target)
    return target


def format_into(graph, target):
    """Writes a stock graph or a graph file as a file in the usual layout. Raises GraphError or ProgramError."""
    try:
        asked = subprocess.run([program.find(preferences().program), "format", graph, "-o", target, "--force"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=20)
    except (OSError, subprocess.TimeoutExpired) as e:
        raise program.ProgramError(f"The program cannot be run: {e}")
    if asked.returncode != 0:
        raise graph_file.GraphError(asked.stdout.decode("utf-8", "replace").strip())


def write_with_defaults(graph, values, path):
    """Writes a graph with values of parameters as their defaults. graph: a file, or stock:NAME."""
    document = graph_file.read(file_of(graph))
    for name, value in values.items():
        declaration = document["parameters"][name]
        declaration["default"] = graph_file.typed(value, declaration.get("type", "text"))
    draft = os.path.join(bpy.app.tempdir, "draft.json")
    with open(draft, "w", encoding="utf-8") as file:
        json.dump(document, file)
    format_into(draft, path)

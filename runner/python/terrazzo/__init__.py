"""terrazzo makes more material out of a small one. See examples/guide/programs.md.

import terrazzo as tz
g = tz.Graph.load("wall.json")
g.params["seed"] = 7
with tz.Session() as s:
    height = s.run(g, only=["result"])["result"]["height"].numpy()
"""

from ._errors import Cancelled, Error, Failure, GraphError, Problem, RunError, UnknownName
from ._graph import Graph, Node, Parameters
from ._nodes import node
from ._plan import Plan, Stage
from ._session import Event, Outcome, Result, Session, Variation, export, set_memory_budget
from ._terrazzo import Image, Material, Report, UvMap, Value, load_plugin
from ._terrazzo import add_note as note
from ._terrazzo import report_progress as progress

__all__ = [
    "Cancelled",
    "Error",
    "Event",
    "Failure",
    "Graph",
    "GraphError",
    "Image",
    "Material",
    "Node",
    "Outcome",
    "Parameters",
    "Plan",
    "Problem",
    "Report",
    "Result",
    "RunError",
    "Session",
    "Stage",
    "UnknownName",
    "UvMap",
    "Value",
    "Variation",
    "export",
    "load_plugin",
    "node",
    "note",
    "progress",
    "set_memory_budget",
]

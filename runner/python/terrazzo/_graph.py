"""Graphs: documents, and values set on them."""

from __future__ import annotations

import json
import os
import warnings
from pathlib import Path
from typing import Any, Iterator, Mapping, MutableMapping, Protocol, Sequence, Union

from . import _terrazzo
from ._errors import Problem, _unknown
from ._nodes import registered
from ._plan import Names, Plan, _list

Value = Union[_terrazzo.Image, _terrazzo.Material, _terrazzo.Report, _terrazzo.UvMap, _terrazzo.Value]
PathLike = Union[str, "os.PathLike[str]"]


def _plain(value: Any) -> Any:
    """Converts what json cannot write: paths, NumPy numbers and arrays, sets of values."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (range, tuple)):
        return list(value)
    raise TypeError(f"a parameter cannot be {value!r} of type {type(value).__name__}")


def _text_of(value: Any) -> str:
    """The value as on the command line, where wires have no quotes."""
    if isinstance(value, str) and value.startswith("@"):
        return value
    return json.dumps(value, default=_plain, ensure_ascii=False, allow_nan=False)


class Parameters(MutableMapping[str, Any]):
    """The parameters of a graph, by name. Deleting one restores the value from the document."""

    _graph: Graph

    def __init__(self, graph: Graph) -> None:
        object.__setattr__(self, "_graph", graph)

    def __setattr__(self, name: str, value: Any) -> None:
        # Nodes have their parameters as attributes; here the value would be lost silently.
        raise AttributeError(f'parameters of the graph are set by name: params["{name}"] = {value!r}')

    def _checked(self, name: str) -> str:
        names = self._graph._outline()["parameters"]
        if name not in names:
            raise _unknown("the graph has no parameter", name, list(names))
        return name

    def __getitem__(self, name: str) -> Any:
        return self._graph._value(self._checked(name))

    def __setitem__(self, name: str, value: Any) -> None:
        self._graph.set(self._checked(name), value)

    def __delitem__(self, name: str) -> None:
        self._graph.unset(self._checked(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._graph._outline()["parameters"])

    def __len__(self) -> int:
        return len(self._graph._outline()["parameters"])

    def describe(self, name: str) -> dict[str, Any]:
        """The type, default, help, range, choices and so on of a parameter."""
        return dict(self._graph._outline()["parameters"][self._checked(name)])

    def __repr__(self) -> str:
        return f"<parameters {dict(self)!r}>"


class Node:
    """A node of a graph. Its parameters and ports are attributes; the value of a port is a wire such as "@exemplar"."""

    _graph: Graph
    _name: str

    def __init__(self, graph: Graph, name: str) -> None:
        object.__setattr__(self, "_graph", graph)
        object.__setattr__(self, "_name", name)

    def _described(self) -> dict[str, Any] | None:
        """None for nodes inside subgraphs: `check` finds wrong names there."""
        node = self._graph._outline()["nodes"].get(self._name)
        return node if node and node["known"] else None

    def _names(self) -> list[str]:
        node = self._described()
        return [*node["params"], *(i["name"] for i in node["inputs"])] if node else []

    def _checked(self, name: str) -> str:
        node = self._described()
        if node and name.split(".")[0] not in self._names() and name != "mute":
            raise _unknown(f'node "{self._name}" ({node["type"]}) has no parameter', name, self._names())
        return f"{self._name}.{name}"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        full = self._checked(name)
        node = self._described()
        default = node["params"].get(name, {}).get("default") if node else None
        return self._graph._value(full, default)

    def __setattr__(self, name: str, value: Any) -> None:
        self._graph.set(self._checked(name), value)

    def __delattr__(self, name: str) -> None:
        self._graph.unset(self._checked(name))

    def __getitem__(self, name: str) -> Any:
        return self.__getattr__(name)

    def __setitem__(self, name: str, value: Any) -> None:
        self.__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return self._names()

    def __repr__(self) -> str:
        node = self._graph._outline()["nodes"].get(self._name, {"type": "?"})
        return f'<node "{self._name}": {node["type"]}>'


class Planner(Protocol):
    """The part of a session that graphs need."""

    def plan(self, graph: Graph, only: Names = ()) -> Plan: ...


class Graph:
    """A graph document, and values set on it. Copies are independent. Use a graph from one thread at a time."""

    def __init__(self, job: _terrazzo.Job) -> None:
        """Use load, loads or stock."""
        self._job = job
        self._known: tuple[int, dict[str, Any]] | None = None

    @classmethod
    def load(cls, path: PathLike) -> Graph:
        """Reads a graph file. Raises GraphError if it is not one."""
        registered()
        return cls(_terrazzo.Job.open(Path(path)))

    @classmethod
    def loads(cls, text: str, path: PathLike = "graph.json") -> Graph:
        """Reads a graph from text. Relative paths in it are relative to the folder of `path`, which need not exist."""
        registered()
        return cls(_terrazzo.Job.from_text(text, Path(path)))

    @classmethod
    def stock(cls, name: str) -> Graph:
        """A graph that comes with terrazzo, such as "material" or "generate-exemplar"."""
        return cls.loads(_terrazzo.stock_text(name), f"{name}.json")

    def copy(self) -> Graph:
        return Graph(self._job.copy())

    @property
    def path(self) -> Path:
        """The file that it was read from."""
        return self._job.path

    def _outline(self) -> dict[str, Any]:
        version = registered()
        if self._known is None or self._known[0] != version:
            self._known = (version, self._job.outline())
        return self._known[1]

    def _value(self, name: str, default: Any = None) -> Any:
        text = self._job.value_of(name)
        return default if text is None else json.loads(text)

    @property
    def params(self) -> Parameters:
        """The parameters of the graph: g.params["seed"] = 7."""
        return Parameters(self)

    @property
    def nodes(self) -> list[str]:
        """The names of the nodes, in the document's order."""
        return list(self._outline()["nodes"])

    def __getitem__(self, node: str) -> Node:
        nodes = self._outline()["nodes"]
        outer = node.split("/")[0].split("[")[0]
        if node not in nodes and (outer == node or outer not in nodes):
            raise _unknown("the graph has no node", node, list(nodes))
        return Node(self, node)

    def __contains__(self, node: str) -> bool:
        return node in self._outline()["nodes"]

    def __iter__(self) -> Iterator[str]:
        return iter(self.nodes)

    def set(self, name: str, value: Any) -> Graph:
        """Sets a parameter of the graph or "node.parameter". Relative paths are relative to the working folder. `check`
        finds wrong values."""
        self._job.set_text(name, _text_of(value))
        return self

    def set_text(self, name: str, text: str) -> Graph:
        """Sets a value as on the command line: "512x512", "=2 * seed"."""
        self._job.set_text(name, text)
        return self

    def unset(self, name: str) -> Graph:
        """Takes back a value that was set."""
        self._job.unset(name)
        return self

    def preset(self, name: str) -> Graph:
        """Applies a preset of the graph. Values that are set override it."""
        self._job.preset(name)
        return self

    def settings(self, path: PathLike) -> Graph:
        """Applies a settings file. It overrides presets; values that are set override it."""
        self._job.settings(Path(path))
        return self

    def give(self, name: str, value: Value) -> Graph:
        """Puts an image, a material or another value into an input of the graph, or in place of a node's result."""
        self._job.give(name, value)
        return self

    def check(self, *, warnings: bool = False) -> list[Problem]:
        """All problems that can be found without running; an empty list if the graph can run. `warnings` adds what is
        allowed but probably unintended (see Problem.severity)."""
        registered()
        return self._job.problems(warnings)

    def plan(self, session: Planner | None = None, only: Names = ()) -> Plan:
        """What a run would do, and why. Without a session, it uses the usual cache."""
        if session is not None:
            return session.plan(self, only)
        own = _terrazzo.Session(Path(), True, 0, 0, False)
        try:
            return Plan(own.plan(_checked(self, _list(only)), _list(only)))
        finally:
            own.close()

    def to_text(self, folder: PathLike = ".") -> str:
        """The document with the values that were set, as it would be saved in that folder."""
        return self._job.text(Path(folder))

    def save(self, path: PathLike) -> None:
        """Writes the document with the values that were set. All else stays as it is, comments and order included.
        Presets, settings files and values in memory are not saved."""
        path = Path(path)
        _terrazzo.write_file(path, self.to_text(path.absolute().parent))
        if path.absolute().parent != self.path.absolute().parent and not self.check():
            if problems := Graph.load(path).check():
                warnings.warn(
                    f"{path} has relative paths that meant something in {self.path.absolute().parent}: {problems[0]}",
                    stacklevel=2,
                )

    def __repr__(self) -> str:
        return f"<Graph {self.path}: {len(self.nodes)} nodes>"


def _checked(graph: Graph, only: Sequence[str]) -> _terrazzo.Checked:
    if not isinstance(graph, Graph):
        raise TypeError(f"expected a Graph, as Graph.load gives, found {graph!r}")
    registered()
    return graph._job.checked(list(only))


def _with(graph: Graph, values: Mapping[str, Any]) -> Graph:
    """A copy with more values set. Raises UnknownName."""
    out = graph.copy()
    for name, value in values.items():
        node, dot, param = name.partition(".")
        if dot and node in out:
            out[node][param] = value
        else:
            out.params[name] = value
    return out

"""Sessions: an open cache, and runs."""

from __future__ import annotations

import itertools
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, Mapping, Union

from . import _terrazzo
from ._errors import Cancelled, Error, Failure, GraphError, RunError, UnknownName, _unknown
from ._graph import Graph, PathLike, Value, _checked, _with
from ._nodes import _cause_of
from ._plan import Names, Plan, _list

#: A number, or a size as the command line takes it, such as "300M".
Bytes = Union[int, str]


def _bytes(what: str, size: Bytes) -> int:
    if isinstance(size, str):
        number = _terrazzo.bytes_from(size)
        if number is None:
            raise ValueError(f'{what}: {_terrazzo.size_help}; "{size}" is not one')
        return number
    if not hasattr(size, "__index__") or size < 0:
        raise TypeError(f'{what}: expected a number of bytes, or a size such as "300M", found {size!r}')
    return int(size)


def set_memory_budget(size: Bytes) -> None:
    """Limits the memory of the process: decoded images, values and running nodes of all sessions. A number of bytes, or
    a size such as "300M"; 0 for half of the machine's memory, the default."""
    _terrazzo.set_memory_budget(_bytes("memory budget", size))


@dataclass(frozen=True)
class Event:
    """The argument of a progress function, which is always called on the thread that called run."""

    #: planned, started, waits, progress, note, finished, reused, not_needed or failed
    kind: str
    node: str
    #: the text of a note or failure; for "planned", a summary of the plan
    message: str
    #: progress of the node, 0 to 1
    fraction: float
    #: time that the node took, once it has finished
    seconds: float
    #: number of nodes that are done, and of all nodes
    done: int
    total: int


@dataclass(frozen=True)
class Outcome:
    """What happened to a node in a run."""

    node: str
    #: idle (not needed), reused, run, failed or unfinished
    kind: str
    #: why it had to run, if the plan could not know
    why: str
    seconds: float
    notes: list[str]
    #: files that it wrote, in this run or before
    files: list[Path]


class Result(Mapping[str, Any]):
    """The result of a run: values by node. A node with one output has that value, others a dictionary by output."""

    def __init__(self, raw: dict[str, Any]) -> None:
        self._kept: dict[str, dict[str, Any]] = raw["kept"]
        #: one for every node, in the graph's order
        self.outcomes: list[Outcome] = [Outcome(*s) for s in raw["stages"]]
        self.seconds: float = raw["seconds"]
        #: "8 stages: 5 cached, 3 run, 1.84 s"
        self.summary: str = raw["summary"]

    @property
    def files(self) -> list[Path]:
        """All files that the sinks wrote, in this run or before."""
        return [f for o in self.outcomes for f in o.files]

    @property
    def notes(self) -> list[str]:
        """The notes of nodes: "node: note"."""
        return [f"{o.node}: {n}" for o in self.outcomes for n in o.notes]

    def __getitem__(self, name: str) -> Any:
        if name in self._kept:
            ports = self._kept[name]
            return next(iter(ports.values())) if len(ports) == 1 else dict(ports)
        node, dot, port = name.rpartition(".")
        if dot and node in self._kept:
            if port in self._kept[node]:
                return self._kept[node][port]
            raise _unknown(f'node "{node}" has no output', port, list(self._kept[node]))
        if any(o.node == name for o in self.outcomes):
            raise UnknownName(f'the value of "{name}" has not been kept: run with keep=["{name}"]')
        raise _unknown("the graph has no node", name, [o.node for o in self.outcomes])

    def __iter__(self) -> Iterator[str]:
        return iter(self._kept)

    def __len__(self) -> int:
        return len(self._kept)

    def __repr__(self) -> str:
        return f"<Result {self.summary}>"


class _Progress:
    """Counts finished nodes, and calls the user's function."""

    def __init__(self, tell: Callable[[Event], Any]) -> None:
        self._tell = tell
        self._done = self._total = 0

    def __call__(self, kind: str, node: str, message: str, fraction: float, seconds: float, total: int) -> None:
        if kind == "planned":
            self._total = total
        elif kind in ("finished", "reused", "failed"):
            self._done += 1
            self._total = max(self._total, self._done)
        self._tell(Event(kind, node, message, fraction, seconds, self._done, self._total))


class Session:
    """An open cache, and limits for runs. Threads may share a session; the limits hold for each run.

    cache: the folder; None for the usual one, False for no cache. threads: 0 for one per core. memory: a budget for
    values and running nodes, in bytes or as "300M"; 0 for that of set_memory_budget, which also covers decoded images.

    checked: runs every node twice, one at a time and without a cache, and watches which files nodes in Python open. A
    node fails if its two results differ, or if it reads a file that no parameter of type Path names."""

    def __init__(
        self, cache: PathLike | bool | None = None, threads: int = 0, memory: Bytes = 0, checked: bool = False
    ) -> None:
        folder = Path() if cache is None or isinstance(cache, bool) else Path(cache)
        self._session = _terrazzo.Session(folder, cache is not False, threads, _bytes("memory", memory), checked)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the cache. Values stay valid. If runs are in progress, they continue, and the last one closes it."""
        self._session.close()

    def cancel(self) -> None:
        """Ends all runs of this session; they raise Cancelled. May be called from any thread."""
        self._session.cancel()

    def take_warnings(self) -> list[str]:
        """Warnings since the last call, about problems that only cost time, such as a full disk."""
        return self._session.take_warnings()

    def plan(self, graph: Graph, only: Names = ()) -> Plan:
        """What a run would do, and why. Raises GraphError."""
        return Plan(self._session.plan(_checked(graph, _list(only)), _list(only)))

    def run(
        self,
        graph: Graph,
        only: Names = (),
        *,
        keep: Names = (),
        progress: Callable[[Event], Any] | None = None,
    ) -> Result:
        """Runs a graph, as far as results are not cached. With `only`, it makes these nodes and returns their values.
        Otherwise it makes all sinks or, in a graph without sinks, all nodes that no other node reads, and returns the
        values of the latter. `keep` names more values to return.

        `progress` is called on this thread. An exception from it ends the run, and so does Ctrl-C. Raises GraphError
        before anything runs, RunError if a node failed, and Cancelled."""
        only = _list(only)
        tell = None if progress is None else _Progress(progress)
        raw = self._session.run(_checked(graph, only), only, _list(keep), tell)
        result = Result(raw)
        if raw["failures"]:
            failures = [Failure(*f) for f in raw["failures"]]
            raise RunError("\n".join(f.message for f in failures), failures, result) from _cause_of(failures)
        if raw["cancelled"]:
            raise Cancelled("the run was cancelled")
        return result

    def sweep(
        self,
        graph: Graph,
        values: Mapping[str, Iterable[Any]] | Iterable[Mapping[str, Any]] | None = None,
        *,
        progress: Callable[[Event], Any] | None = None,
        **more: Iterable[Any],
    ) -> Iterator[Variation]:
        """Variations of the graph, with every combination of several values: sweep(g, seed=range(64)), or
        {"lattice.mode": [...]} for names with dots. The last name changes fastest. A text is one value. A list of
        dictionaries is a table with a row for each variation.

        All variations are checked before this returns. Each runs when you ask for one of its results; what variations
        share is in the cache."""
        rows = [dict(r) for r in values] if values is not None and not isinstance(values, Mapping) else [{}]
        columns = {**(values if isinstance(values, Mapping) else {}), **more}
        lists = [_several(name, v) for name, v in columns.items()]
        combinations = [dict(zip(columns, c)) for c in itertools.product(*lists)]
        all_values = [{**row, **c} for row in rows for c in combinations]
        graphs = [_with(graph, v) for v in all_values]
        for g in graphs:
            _check_but_unset(g)
        written: dict[str, str] = {}
        return (Variation(self, g, v, progress, written) for g, v in zip(graphs, all_values))


def _several(name: str, values: Any) -> list[Any]:
    """The values to sweep over; a text is one value, not its letters."""
    if isinstance(values, (str, bytes)):
        return [values]
    try:
        return list(values)
    except TypeError:
        raise TypeError(f"{name}: expected several values, such as [{values!r}], found {values!r}") from None


def _check_but_unset(graph: Graph) -> None:
    """Checks all but missing values, which the requested nodes may not need."""
    try:
        _checked(graph, ())
    except GraphError as error:
        if any(p.code != "unset" for p in error.problems):
            raise


def _shown(value: Any) -> str:
    return "x".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


class Variation:
    """One variation of a sweep: a graph, its values, and the results of its run."""

    def __init__(
        self, session: Session, graph: Graph, values: dict[str, Any], progress: Callable[[Event], Any] | None,
        written: dict[str, str],
    ) -> None:
        self._session = session
        self._progress = progress
        self._results: dict[str, Result] = {}
        #: for each path that a variation of the sweep has exported to, the label of that variation
        self._written = written
        #: the graph with the values set
        self.graph = graph
        #: the values by name
        self.values = values

    @property
    def label(self) -> str:
        """ "seed=3, size=512x512" """
        return ", ".join(f"{name}={_shown(value)}" for name, value in self.values.items())

    def run(self, only: Names = (), *, keep: Names = ()) -> Result:
        return self._session.run(self.graph, only, keep=keep, progress=self._progress)

    def __getitem__(self, name: str) -> Any:
        """The value of a node; runs the node if it has not run yet."""
        node = name if name in self.graph else name.rpartition(".")[0] or name
        if node not in self._results:
            self._results[node] = self.run([node])
        return self._results[node][name]

    def _filled(self, path: PathLike) -> str:
        """Fills in {seed} and so on; {label} is all of them. Other names in braces are for the export node."""
        text = os.fspath(path).replace("{label}", self.label)
        for name, value in self.values.items():
            text = text.replace("{" + name + "}", _shown(value))
        return text

    def _take(self, pattern: str) -> None:
        """Raises if another variation wrote this path. Paths with a size or material are unknown before the run."""
        if any(place in pattern for place in ("{width}", "{height}", "{material}")):
            return
        other = self._written.setdefault(os.path.abspath(_pattern(pattern)), self.label)
        if other != self.label:
            name = next(iter(self.values), "label")
            raise Error(
                f"{pattern} would be written for {other} and for {self.label}; let the path tell them apart, as "
                f'v.export("out/{{{name}}}") or v.export("out/{{label}}") does'
            )

    def export(self, path: PathLike, node: str | None = None) -> list[Path]:
        """Writes the maps of the node's material. Without `node`, runs the graph's first export node with this path. A
        path without the extension of a picture is a folder. {seed}, {label} and so on stand for the values. Raises
        Error if another variation of the sweep was written to the same path."""
        pattern = self._filled(path)
        self._take(pattern)
        if node is not None:
            return export(self[node], pattern, session=self._session)
        sinks = [n for n in self.graph if self.graph._outline()["nodes"][n]["type"] == "export"]
        if not sinks:
            raise UnknownName('the graph has no export node: say which node to export, as in v.export(path, "result")')
        graph = self.graph.copy()
        graph.set(f"{sinks[0]}.path", _pattern(pattern))
        return self._session.run(graph, sinks[:1], progress=self._progress).files

    def __repr__(self) -> str:
        return f"<Variation {self.label}>"


_PICTURES = (".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg", ".tga", ".tx")


def _pattern(path: str) -> str:
    is_pattern = path.lower().endswith(_PICTURES) or "{map}" in os.path.basename(path)
    return path if is_pattern else os.path.join(path, "{map}.png")


_EXPORT = """{
  "terrazzo": 1,
  "inputs": {"value": {"type": "%s"}},
  "nodes": {"files": {"type": "export", "%s": "@value"}}
}"""


def export(value: Value, path: PathLike, *, session: Session | None = None, **params: Any) -> list[Path]:
    """Writes the maps of a material or image, or a uv map: to a folder, or to a pattern such as "out/{map}.exr". Other
    arguments are parameters of the export node, such as depth="half". Returns the files."""
    is_map = isinstance(value, _terrazzo.UvMap)
    port, kind = ("uv", "uv_map") if is_map else ("material", "material")
    graph = Graph.loads(_EXPORT % (kind, port)).give("value", value)
    node = graph["files"]
    node["uv_path" if is_map else "path"] = os.fspath(path) if is_map else _pattern(os.fspath(path))
    for name, setting in params.items():
        node[name] = setting
    if session is not None:
        return session.run(graph).files
    with Session(cache=False) as own:
        return own.run(graph).files

"""Errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

from . import _terrazzo


@dataclass(frozen=True)
class Problem:
    """A mistake in a graph, or something that is probably unintended."""

    message: str
    #: a JSON pointer (RFC 6901) such as /nodes/lattice/mode; empty if it concerns no part of the document
    pointer: str
    #: line and column in the file, from 1; 0 if it is not in the file, such as a value that was set
    line: int
    column: int
    #: the kind of problem: "parameter", "wire", "override", "input", ...
    code: str
    #: the node that it concerns; may be empty
    node: str
    file: str
    #: "error" or "warning"
    severity: str = "error"

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}" if self.line else self.pointer or self.file
        return f"{place}: {self.message}"


@dataclass(frozen=True)
class Failure:
    """A node that failed in a run."""

    node: str
    message: str

    def __str__(self) -> str:
        return self.message


class Error(Exception):
    """The base class of all exceptions that terrazzo raises."""


class GraphError(Error):
    """The graph cannot be read or run. `problems` has all problems that were found."""

    def __init__(self, message: str, problems: Sequence[Problem] = ()) -> None:
        super().__init__(message)
        self.problems: list[Problem] = list(problems)


class RunError(Error):
    """Nodes failed in a run. `failures` says which; `result` is the result of the rest."""

    def __init__(self, message: str, failures: Sequence[Failure] = (), result: Any = None) -> None:
        super().__init__(message)
        self.failures: list[Failure] = list(failures)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        """Everything but the values goes to another process."""
        return RunError, (str(self), self.failures)


class Cancelled(Error):
    """The run was cancelled by Session.cancel, or by a progress function or node that raised this."""


class UnknownName(Error, AttributeError, KeyError):
    """A graph, a node or a result has no such name; the message suggests the nearest one."""

    def __str__(self) -> str:
        return str(self.args[0])


def _unknown(what: str, name: str, names: Sequence[str]) -> UnknownName:
    return UnknownName(f'{what} "{name}"{_terrazzo.suggestion(name, list(names))}')

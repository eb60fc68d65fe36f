"""What goes wrong, and where."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

from . import _terrazzo


@dataclass(frozen=True)
class Problem:
    """Something wrong in a graph, or hardly meant."""

    message: str
    #: a JSON pointer (RFC 6901) such as /nodes/lattice/mode; empty if it is about no part of the document
    pointer: str
    #: where it stands in the file, from 1; 0 if it does not stand there, as a value that has been set
    line: int
    column: int
    #: its kind: "parameter", "wire", "override", "input", ...
    code: str
    #: the node that it is about; may be empty
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
    """Whatever terrazzo raises is one of these."""


class GraphError(Error):
    """A graph that cannot be read or run. `problems` says why: all that was found."""

    def __init__(self, message: str, problems: Sequence[Problem] = ()) -> None:
        super().__init__(message)
        self.problems: list[Problem] = list(problems)


class RunError(Error):
    """A run in which nodes failed. `failures` says which, `result` what else is known."""

    def __init__(self, message: str, failures: Sequence[Failure] = (), result: Any = None) -> None:
        super().__init__(message)
        self.failures: list[Failure] = list(failures)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        """To another process goes all but the values."""
        return RunError, (str(self), self.failures)


class Cancelled(Error):
    """The run was cancelled: by Session.cancel, or by a progress function or a node that raised this."""


class UnknownName(Error, AttributeError, KeyError):
    """A name that a graph, a node or a result does not have; the message has the nearest."""

    def __str__(self) -> str:
        return str(self.args[0])


def _unknown(what: str, name: str, names: Sequence[str]) -> UnknownName:
    return UnknownName(f'{what} "{name}"{_terrazzo.suggestion(name, list(names))}')

"""Plans: what a run would do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence, Union

from ._errors import _unknown

Names = Union[str, Sequence[str]]


def _list(names: Names) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


@dataclass(frozen=True)
class Stage:
    """A node in a plan."""

    node: str
    #: not needed, cached, up to date, derived, depends or run
    state: str
    #: the reason why it must run
    why: str
    #: expected time, from earlier runs
    seconds: float


class Plan(Sequence[Stage]):
    """What a run would do. Printed as a table: node, state, why."""

    def __init__(self, plan: dict[str, Any]) -> None:
        self._stages = [Stage(*s) for s in plan["stages"]]
        self._table: str = plan["table"]
        #: "12 stages: 9 cached, 3 to run"
        self.summary: str = plan["summary"]

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, str):
            for s in self._stages:
                if s.node == index:
                    return s
            raise _unknown("the plan has no node", index, [s.node for s in self._stages])
        return self._stages[index]

    def __len__(self) -> int:
        return len(self._stages)

    def __str__(self) -> str:
        return self._table.rstrip("\n")

    def __repr__(self) -> str:
        return f"<Plan {self.summary}>"

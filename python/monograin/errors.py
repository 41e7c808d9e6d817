"""Errors of the package.

A scenario that cannot be run is a :class:`ScenarioError`. A run that leaves the domain of its model is no error: its
status is ``"stopped"``. A solver that gives up is a :class:`SolverError`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterable, Optional

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .runs import Run


@dataclass(frozen=True)
class Fault:
    """One fault of a scenario.

    Attributes:
        file: name of the text with the fault: a file, or ``override '...'`` for a value given to
            :meth:`monograin.Scenario.replace`.
        line: line of the fault, from 1.
        column: column of the fault, from 1.
        text: message: what was found and what is expected.
    """

    file: str
    line: int
    column: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}: {self.text}"


class ScenarioError(ValueError):
    """A scenario, sweep, calibration or plan has faults.

    Attributes:
        faults: every :class:`Fault`, in the order of the text. The message has one line for each.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[Any, ...]:
        return (ScenarioError, (self.faults,))


class SolverError(RuntimeError):
    """A solver gave up before a run was complete.

    Attributes:
        run: the :class:`monograin.Run` up to the failure. None in an error that comes from another process.
    """

    def __init__(self, message: str, run: Optional[Run] = None) -> None:
        self.run = run
        super().__init__(message)

    def __reduce__(self) -> tuple[Any, ...]:
        return (SolverError, (str(self),))


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has stopped :meth:`monograin.Prepared.map`.

    Attributes:
        table: array of shape (n, columns), as :meth:`monograin.Prepared.map` returns it; nan in rows that were not run.
        statuses: array of n words; ``"pending"`` for rows that were not run.
    """

    def __init__(self, table: NDArray[np.float64], statuses: NDArray[np.str_]) -> None:
        self.table = table
        self.statuses = statuses
        done = int((statuses != "pending").sum())
        super().__init__(f"stopped after {done} of {len(statuses)} runs")

    def __reduce__(self) -> tuple[Any, ...]:
        return (Interrupted, (self.table, self.statuses))

"""Many runs of one scenario with other numbers."""

from __future__ import annotations

from typing import Any, Iterable, Literal, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Interrupted
from .runs import Run, Scenario, checked

_STATUSES = np.array(["pending", "complete", "stopped", "failed", "refused"])


class Prepared:
    """A scenario with keys of numbers that change from run to run; made by :meth:`monograin.Scenario.prepare`.

    Every run gives the same numbers, bit by bit, as the scenario with these values written into its text.
    """

    def __init__(self, scenario: Scenario, keys: Iterable[str]) -> None:
        self._scenario = scenario
        self._core = scenario._core.prepare(list(keys))

    @property
    def scenario(self) -> Scenario:
        """The scenario, with its own numbers."""
        return self._scenario

    @property
    def keys(self) -> list[str]:
        """Paths of the keys, in the order of the values."""
        return self._core.keys

    def run(self, values: ArrayLike, *, check: bool = True) -> Run:
        """Runs the scenario with these values. Other threads go on meanwhile.

        Args:
            values: array of shape (keys,) in SI units.
            check: as in :meth:`monograin.Scenario.run`.

        Raises:
            ScenarioError: where the scenario refuses a value.
            SolverError: as in :meth:`monograin.Scenario.run`.
            ValueError: for another number of values.
        """
        return checked(Run(self._core.run(np.ascontiguousarray(values, dtype=float))), check)

    @overload
    def map(
        self, samples: ArrayLike, columns: Sequence[str], *, threads: int = ..., statuses: Literal[False] = ...
    ) -> NDArray[np.float64]: ...

    @overload
    def map(
        self, samples: ArrayLike, columns: Sequence[str], *, threads: int = ..., statuses: Literal[True]
    ) -> tuple[NDArray[np.float64], NDArray[np.str_]]: ...

    def map(
        self, samples: ArrayLike, columns: Sequence[str], *, threads: int = 0, statuses: bool = False
    ) -> Union[NDArray[np.float64], tuple[NDArray[np.float64], NDArray[np.str_]]]:
        """Runs the scenario once for each row of samples, on several threads.

        Args:
            samples: array of shape (n, keys) in SI units; of one key also (n,).
            columns: formulas of the history's columns that give one number each, such as ``"max(axial.force)"`` or
                ``"end(apparent_radius) / 0.01"``: numbers, names of columns, ``+ - * / ^``, brackets, ``sqrt`` and other
                functions, and ``min``, ``max``, ``last`` (the last value that is defined) and ``end`` (that of the last
                row).
            threads: 0 for one for each core.
            statuses: whether to return how the runs ended as well.

        Returns:
            Array of shape (n, columns). A run that stops at a limit of its model counts up to there. A row is nan where
            the solver gave up or the scenario refuses the values. With ``statuses``, also an array of n words:
            ``"complete"``, ``"stopped"``, ``"failed"`` or ``"refused"``.

        Raises:
            KeyError: for a formula with a name that is no column.
            ValueError: for a text that is no formula, a formula that gives more than one number, and samples of another
                shape.
            Interrupted: on Ctrl-C, with the rows that are there already. It is a ``KeyboardInterrupt``.
        """
        if threads < 0:
            raise ValueError(f"threads = {threads}: expected 0 for one for each core, or more")
        if isinstance(columns, str):
            raise ValueError("columns: expected a list of formulas, not one str")
        values = np.ascontiguousarray(samples, dtype=float)
        if values.ndim == 1 and len(self.keys) == 1:
            values = values[:, np.newaxis]
        if values.ndim != 2 or values.shape[1] != len(self.keys):
            raise ValueError(f"samples of shape {values.shape} for {len(self.keys)} keys; expected (n, {len(self.keys)})")
        table = np.full((len(values), len(columns)), np.nan)
        codes = np.zeros(len(values), dtype=np.int8)
        try:
            self._core.map(values, list(columns), threads, table, codes)
        except KeyboardInterrupt as interrupt:
            raise Interrupted(table, _STATUSES[codes]) from interrupt
        return (table, _STATUSES[codes]) if statuses else table

    def __reduce__(self) -> tuple[Any, ...]:
        return (Prepared, (self._scenario, self.keys))

    def __repr__(self) -> str:
        return f"<Prepared {self._scenario.name!r}: {', '.join(self.keys)}>"

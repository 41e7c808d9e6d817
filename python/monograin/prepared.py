"""Many runs of one scenario with other numbers."""

from __future__ import annotations

from typing import Any, Iterable, Literal, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import Interrupted
from .runs import Run, Scenario, checked


class Prepared:
    """A scenario with keys of numbers that change from run to run; made by :meth:`monograin.Scenario.prepare`.

    Every run gives the same numbers, bit by bit, as the scenario with these values written into its text.
    """

    def __init__(self, scenario: Scenario, keys: Iterable[str]) -> None:
        self._scenario = scenario
        self._core = _core.Prepared(scenario._core, list(keys))

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
        numbers = np.array(values, dtype=float)
        core = self._core.run(numbers)
        return checked(Run(core, lambda: self._scenario.replace(dict(zip(self.keys, numbers.tolist())))), check)

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

        Numbers agree with those of ``run`` to round-off. What the formulas do not read is not computed: the energies,
        and, where every name stands alone in ``end``, all rows before the last.

        Args:
            samples: array of shape (n, keys) in SI units; of one key also (n,).
            columns: formulas of the history's columns that give one number each, such as ``"max(axial.force)"`` or
                ``"end(apparent_radius) / 0.01"``: numbers, names of columns, ``+ - * / ^``, brackets, ``sqrt`` and other
                functions, and ``min``, ``max``, ``last`` (the last value that is defined) and ``end`` (that of the last
                row, defined or not).
            threads: 0 for one for each core.
            statuses: whether to return how the runs ended as well.

        Returns:
            Array of shape (n, columns). A run that stops at a limit of its model, or whose solver gives up, counts up to
            there. A row is nan where the scenario refuses the values. With ``statuses``, also an array of n words:
            ``"complete"``, ``"stopped"``, ``"failed"`` or ``"refused"``.

        Raises:
            ValueError: for a text that is no formula, a name in it that is no column, a formula that gives more than one
                number, and samples of another shape.
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
        results, words, raised = self._core.map(values, list(columns), threads)
        table = results.reshape(len(values), len(columns))
        ends = np.array([word or "pending" for word in words], dtype=str)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(table, ends) from raised
        if raised is not None:
            raise raised
        return (table, ends) if statuses else table

    def __reduce__(self) -> tuple[Any, ...]:
        return (Prepared, (self._scenario, self.keys))

    def __repr__(self) -> str:
        return f"<Prepared {self._scenario.name!r}: {', '.join(self.keys)}>"

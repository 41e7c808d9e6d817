"""Prepared scenarios: many runs of one scenario with different values of some keys."""

from __future__ import annotations

import operator
from typing import Any, Iterable, Literal, Mapping, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._inputs import explained, numbers
from .errors import Interrupted
from .runs import Run, Scenario, checked


class Prepared:
    """A scenario that is read once and run with different values of some keys.

    :meth:`monograin.Scenario.prepare` makes it. Results of :meth:`run` are bitwise equal to those of the scenario with
    these values in its text; those of :meth:`map` agree with them to round-off.
    """

    __slots__ = ("_scenario", "_core")

    @explained
    def __init__(self, scenario: Scenario, keys: Iterable[str]) -> None:
        if isinstance(keys, str):
            raise TypeError(f"keys: expected a list of keys, such as [{keys!r}], not one str")
        names = list(keys)
        if not all(isinstance(name, str) for name in names):
            raise TypeError(f"keys: expected a list of str, not {names!r}")
        self._core = _core.Prepared(scenario._core, names)
        self._scenario = scenario

    @property
    def scenario(self) -> Scenario:
        """The scenario, with its own values of the keys."""
        return self._scenario

    @property
    def keys(self) -> list[str]:
        """Paths of the keys that vary, in the order in which ``run`` and ``map`` take their values."""
        return self._core.keys

    def run(self, values: Union[ArrayLike, Mapping[str, float]], *, check: bool = True) -> Run:
        """Runs the scenario with these values. Other threads continue during the run.

        Args:
            values: array of shape (keys,) in SI units, or a mapping or pandas.Series with a value for each key.
            check: as in :meth:`monograin.Scenario.run`.

        Raises:
            ScenarioError: if a value is not admissible.
            SolverError: as in :meth:`monograin.Scenario.run`.
            ValueError: if the number of values is not that of the keys.
            TypeError: for values that are no real numbers.
            KeyboardInterrupt: on Ctrl-C, in the main thread of Python.
        """
        row = self._in_order("values", values, getattr(values, "index", None))
        if row.ndim != 1:
            raise ValueError(f"values of shape {row.shape}; expected ({len(self.keys)},)")
        core = self._core.run(row)
        return checked(Run(core, lambda: self._scenario.replace(dict(zip(self.keys, row.tolist())))), check)

    @overload
    def map(
        self, samples: Union[ArrayLike, Mapping[str, ArrayLike]], columns: Sequence[str], *, threads: int = ..., statuses: Literal[False] = ...
    ) -> NDArray[np.float64]: ...

    @overload
    def map(
        self, samples: Union[ArrayLike, Mapping[str, ArrayLike]], columns: Sequence[str], *, threads: int = ..., statuses: Literal[True]
    ) -> tuple[NDArray[np.float64], NDArray[np.str_]]: ...

    @overload
    def map(
        self, samples: Union[ArrayLike, Mapping[str, ArrayLike]], columns: Sequence[str], *, threads: int = ..., statuses: bool
    ) -> Union[NDArray[np.float64], tuple[NDArray[np.float64], NDArray[np.str_]]]: ...

    @explained
    def map(
        self, samples: Union[ArrayLike, Mapping[str, ArrayLike]], columns: Sequence[str], *, threads: int = 0, statuses: bool = False
    ) -> Union[NDArray[np.float64], tuple[NDArray[np.float64], NDArray[np.str_]]]:
        """Runs the scenario once for each row of samples, on several threads.

        Numbers agree with those of ``run`` to round-off. Parts of a history that no formula reads are not computed: the
        energies and, if every name stands alone in ``end``, all rows before the last.

        Args:
            samples: array of shape (n, keys) in SI units; for a single key also (n,). A DataFrame, or a mapping
                from keys to arrays, with a column for each key: its columns are found by their names. Rows with a nan,
                or a masked or missing value, are refused.
            columns: formulas over the columns of numbers of the history with one value each, such as
                ``"max(axial.force)"`` or ``"end(apparent_radius) / 0.01"``. A formula has numbers, names of columns
                (``axial.force``) or their headings (``axial.force[N]``), ``+ - * / ^``, brackets,
                ``sqrt`` and other functions, ``min``, ``max``, ``last`` (last defined value) and ``end`` (value in the
                last row, even if undefined).
            threads: number of threads; 0: one for each core.
            statuses: True to return also the status of every run.

        Returns:
            Array of shape (n, columns). A run that stops at a limit of its model, or whose solver gives up, is
            evaluated up to there. A row is nan if the scenario refuses the values, and a value is nan if the run lacks
            a column because walls have merged into one class. With ``statuses``, also an array of
            n words: ``"complete"``, ``"stopped"``, ``"failed"`` or ``"refused"``.

        Raises:
            ValueError: for a formula that cannot be read, names a column of words or one that the scenario does not
                have, or has more than one value, and for samples of another shape or without a key.
            TypeError: for samples that are no real numbers.
            Interrupted: on Ctrl-C, with the rows that are complete. It is a ``KeyboardInterrupt``.
        """
        if threads < 0:
            raise ValueError(f"threads = {threads}: expected 0 for one for each core, or more")
        if isinstance(columns, str) or not all(isinstance(column, str) for column in columns):
            raise ValueError(f"columns: expected a list of formulas, not {columns!r}")
        values = self._in_order("samples", samples, getattr(samples, "columns", None))
        if values.ndim == 1 and (len(self.keys) == 1 or values.size == 0):
            values = values.reshape(-1, len(self.keys))
        if values.ndim != 2 or values.shape[1] != len(self.keys):
            raise ValueError(f"samples of shape {values.shape} for {len(self.keys)} keys; expected (n, {len(self.keys)})")
        results, words, raised = self._core.map(values, list(columns), operator.index(threads))
        table = results.reshape(len(values), len(columns))
        ends = np.array([word or "pending" for word in words], dtype=str)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(table, ends) from raised
        if raised is not None:
            raise raised
        return (table, ends) if statuses else table

    def _in_order(self, argument: str, values: Any, names: Any) -> NDArray[np.float64]:
        """Returns values as an array, in the order of the keys if the values or the given names of them are texts."""
        if isinstance(values, Mapping):
            names = values
        if names is None or callable(names) or not all(isinstance(name, str) for name in names):
            return numbers(values, argument)
        given = list(names)
        if len(given) != len(self.keys) or set(given) != set(self.keys):
            raise ValueError(f"values for {', '.join(map(repr, given))}; expected the keys {', '.join(map(repr, self.keys))}")
        columns = [numbers(values[key], f"{argument}: {key!r}") for key in self.keys]
        if any(column.shape != columns[0].shape for column in columns):
            shapes = ", ".join(f"{column.shape} for {key!r}" for key, column in zip(self.keys, columns))
            raise ValueError(f"{argument} of shapes {shapes}; expected equal ones")
        return np.stack(columns, axis=-1)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Prepared, (self._scenario, self.keys))

    def __repr__(self) -> str:
        return f"<Prepared {self._scenario.name!r}: {', '.join(self.keys)}>"

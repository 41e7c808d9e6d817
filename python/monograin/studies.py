"""Sweeps, calibrations and comparisons."""

from __future__ import annotations

import json
import os
import warnings
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .runs import Path, Run
from .tables import Table


def sweep(
    file: Path, folder: Optional[Path] = None, *, threads: int = 0, shard: tuple[int, int] = (1, 1)
) -> Optional[Table]:
    """Runs a sweep file, as ``monograin sweep`` does: on all cores, and on from where it was stopped.

    Args:
        file: a sweep file (TOML).
        folder: of the results; ``runs/NAME`` if None.
        threads: 0 for one for each core.
        shard: (i, n) for every n-th run only, from the i-th on. The last of n processes with one folder merges.

    Returns:
        The results: a row for each run with its keys, ``status``, ``reason``, and the final (``end.axial.force``) and
        largest (``max.axial.force``) value of every column. None where runs are left to other shards. The table is
        ``results.csv`` in the folder; percentiles of the histories, where the file has ``[bands]``, are ``bands.csv``.

    Raises:
        ScenarioError: with every fault of the sweep and its scenario.
        RuntimeError: where the folder holds something else or cannot be written.
        KeyboardInterrupt: on Ctrl-C. Finished runs are kept in the folder, and the next call goes on from there.
    """
    where, missing = _core.sweep(os.fspath(file), "" if folder is None else os.fspath(folder), threads, *shard)
    return Table.read_csv(os.path.join(where, "results.csv")) if missing == 0 else None


def sensitivity(file: Path, folder: Optional[Path] = None, *, threads: int = 0, confidence: float = 0.95) -> Table:
    """Says which key the spread of results is due to, as ``monograin sensitivity`` does.

    Args:
        file: a sweep file (TOML) of design ``saltelli`` or ``morris``, with the ``results`` that are asked for.
        folder: of the results; ``runs/NAME`` if None. Runs that are there are not done again.
        threads: 0 for one for each core.
        confidence: level of the two-sided bootstrap intervals, between 0 and 1.

    Returns:
        A row for each result and key. Of ``saltelli`` the shares of the variance ``first`` and ``total`` with the ends of
        their intervals (Saltelli et al., 2010; Jansen, 1999); of ``morris`` ``mean_size``, ``mean`` and
        ``standard_deviation`` of the elementary effects over the whole range of a key (Morris, 1991). The table is
        ``sensitivity.csv`` in the folder, beside its figure.

    Raises:
        ScenarioError: with every fault of the sweep and its scenario.
        ValueError: for another design, or a confidence outside of (0, 1).
        RuntimeError: for a formula that the columns of the results cannot answer.
    """
    if not 0.0 < confidence < 1.0:
        raise ValueError("confidence: expected a number in (0, 1)")
    where = _core.sensitivity(os.fspath(file), "" if folder is None else os.fspath(folder), threads, confidence)
    return Table.read_csv(os.path.join(where, "sensitivity.csv"))


class FittedParameter(NamedTuple):
    """A number of a scenario that was fitted; all in SI units.

    Attributes:
        value: of the best fit.
        standard_error: of the linearised fit; nan where the data do not tell it.
        interval: two-sided, at the level of the calibration: of the covariance, the profile or the bootstrap,
            as ``[fit] intervals`` has it; need not be symmetric, and may end at a bound.
        bounds: between which the value was sought.
        at_bound: ``"lower"`` or ``"upper"`` where the value sits at a bound, else None.
        is_determined: whether the data tell the value.
    """

    value: float
    standard_error: float
    interval: tuple[float, float]
    bounds: tuple[float, float]
    at_bound: Optional[str]
    is_determined: bool


class Calibration:
    """Result of a calibration: fitted numbers, their uncertainty, and the fit itself."""

    def __init__(self, core: _core.Fitted) -> None:
        self._core = core
        self._info: dict[str, Any] = json.loads(core.json)

    @property
    def parameters(self) -> dict[str, FittedParameter]:
        """The fitted numbers, by their keys."""
        return {
            entry["key"]: FittedParameter(
                entry["value"],
                _number(entry["standard_error"]),
                (_number(entry["interval"][0]), _number(entry["interval"][1])),
                (entry["bounds"][0], entry["bounds"][1]),
                entry["at_bound"],
                entry["is_determined"],
            )
            for entry in self._info["parameters"]
        }

    @property
    def values(self) -> dict[str, float]:
        """Best values by key, in SI units, as :meth:`monograin.Scenario.replace` takes them."""
        return {key: parameter.value for key, parameter in self.parameters.items()}

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance matrix of the parameters in SI units, shape (p, p); nan for those the data do not tell."""
        return _matrix(self._info["covariance"])

    @property
    def correlation(self) -> NDArray[np.float64]:
        """Correlation matrix of the parameters, shape (p, p)."""
        return _matrix(self._info["correlation"])

    @property
    def fit(self) -> Table:
        """Data, fit, residual, confidence band and weight, row by row."""
        return Table(self._core.fit)

    @property
    def notes(self) -> list[str]:
        """Remarks on the fit, a sentence each."""
        return self._core.notes

    @property
    def warnings(self) -> list[str]:
        """Why the fit is not to be trusted, with the likely cause; empty where it is good."""
        return self._core.warnings

    @property
    def scenario_text(self) -> str:
        """The scenario with the fitted numbers, as TOML text."""
        return self._core.scenario_text

    @property
    def info(self) -> dict[str, Any]:
        """Record of the calibration, as ``calibration.json`` holds it: parameters, statistics, minima, data."""
        return self._info

    def __str__(self) -> str:
        return self._core.text

    def __repr__(self) -> str:
        return f"<Calibration {self._core.name!r}: {', '.join(self.parameters)}>"


def calibrate(file: Path, folder: Optional[Path] = None, *, confidence: Optional[float] = None) -> Calibration:
    """Fits numbers of a scenario to measured data, as ``monograin calibrate`` does.

    A bad fit is warned of (RuntimeWarning), as is a figure that could not be drawn.

    Args:
        file: a calibration file (TOML).
        folder: for the files of the program; None: none are written.
        confidence: level of the intervals in (0, 1); None: that of the file, or 0.95.

    Raises:
        ScenarioError: with every fault of calibration, scenario and data.
        KeyboardInterrupt: on Ctrl-C; nothing has been written then.
    """
    level = float("nan") if confidence is None else confidence
    core = _core.calibrate(os.fspath(file), "" if folder is None else os.fspath(folder), level)
    if core.no_figure:
        warnings.warn(f"no figure: {core.no_figure}", RuntimeWarning, stacklevel=2)
    for warning in core.warnings:
        warnings.warn(warning, RuntimeWarning, stacklevel=2)
    return Calibration(core)


class CurveDifference(NamedTuple):
    """How far a column of one table is from that of a reference.

    Attributes:
        y: heading of the column.
        linf: largest difference over the largest magnitude of the reference.
        linf_at: x of that difference.
        l2: root of the integral of the squared difference over x, relative to that of the reference.
        area_error: root of the integral of the squared difference over x, over the integral of the magnitude of the
            reference (Edmans and Sinka, eq. 7).
        peak_error: largest difference over the reference at its largest x (Edmans and Sinka, eq. 8).
        coverage: share of the reference's path on which the tables could be compared.
    """

    y: str
    linf: float
    linf_at: float
    l2: float
    area_error: float
    peak_error: float
    coverage: float


class Gap(NamedTuple):
    """A column of the reference that could not be compared in full.

    Attributes:
        column: its name.
        problem: goes on from the name: ``"is missing"``.
    """

    column: str
    problem: str


class Comparison(NamedTuple):
    """Differences of two tables.

    Attributes:
        curves: one :class:`CurveDifference` for each column of numbers that both have.
        gaps: columns that are missing or not covered.
    """

    curves: list[CurveDifference]
    gaps: list[Gap]


def compare(a: Union[Run, Table, Path], b: Union[Run, Table, Path], *, x: str = "time", y: str = "") -> Comparison:
    """Compares b with the reference a, as ``monograin compare`` does.

    Args:
        a: reference: a run, a table, the folder of a run, or a CSV file.
        b: what is compared with it.
        x: column to compare over.
        y: column to compare; empty: every column, and of two runs their events.

    Raises:
        RuntimeError: where the reference lacks a column that was named, or the curves have no common range.
    """
    curves, gaps = _core.compare_tables(_history(a)._core, _history(b)._core, x, y)
    events_a, events_b = _events(a), _events(b)
    if not y and events_a is not None and events_b is not None:
        more_curves, more_gaps = _core.compare_events(events_a._core, events_b._core)
        curves, gaps = curves + more_curves, gaps + more_gaps
    return Comparison([CurveDifference(*curve) for curve in curves], [Gap(*gap) for gap in gaps])


def _history(source: Union[Run, Table, Path]) -> Table:
    if isinstance(source, Run):
        return source.history
    if isinstance(source, Table):
        return source
    return Table.read_csv(os.path.join(source, "history.csv") if os.path.isdir(source) else source)


def _events(source: Union[Run, Table, Path]) -> Optional[Table]:
    if isinstance(source, Run):
        return source.events
    if isinstance(source, Table) or not os.path.isdir(source):
        return None
    return Table.read_csv(os.path.join(source, "events.csv"))


def _number(value: Optional[float]) -> float:
    return float("nan") if value is None else value


def _matrix(rows: list[list[Optional[float]]]) -> NDArray[np.float64]:
    return np.array([[_number(value) for value in row] for row in rows])

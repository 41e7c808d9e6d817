"""Studies: sweeps, calibrations, plans of experiments, comparisons."""

from __future__ import annotations

import copy
import html
import json
import os
import types
import warnings
from typing import Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core, _html, _toml
from ._core import Designed, Fitted
from ._inputs import Named, explained, same, shown
from ._optional import Axes, DataFrame, Figure
from .runs import Path, Run, Scenario
from .tables import Table

Source = Union[Path, Mapping[str, Any]]
Curves = Union[Run, Table, Path, Mapping[str, Any], DataFrame]


class Sweep(Table):
    """Results of a sweep: a :class:`Table` with a row for each run, and the number of points without one."""

    __slots__ = ("_left_out",)

    def __init__(self, core: _core.Table, left_out: int) -> None:
        super().__init__(core)
        self._left_out = left_out

    @property
    def left_out(self) -> int:
        """Number of points of the design that do not meet its constraints. They are not run, and have no row."""
        return self._left_out

    def __reduce__(self) -> tuple[Any, ...]:
        make, arguments = super().__reduce__()
        return (_sweep_of, (make, arguments, self._left_out))


def _sweep_of(make: Callable[..., Table], arguments: tuple[Any, ...], left_out: int) -> Sweep:
    return Sweep(make(*arguments)._core, left_out)


@explained
def sweep(
    source: Source,
    folder: Optional[Path] = None,
    *,
    threads: int = 0,
    shard: tuple[int, int] = (1, 1),
    format: Optional[str] = None,
) -> Optional[Sweep]:
    """Runs a sweep on several threads, as ``monograin sweep`` does.

    An interrupted sweep goes on from the runs that are in its folder. Results of another sweep there are replaced. Values
    that may not be meant as they are read, runs that warn, stop or fail or are refused, and a figure that cannot be drawn,
    give a ``RuntimeWarning``.

    Args:
        source: a sweep file (TOML), or a dict of the same structure, whose file names are relative to the current
            folder. In a dict, the scenario may be a :class:`Scenario` or a dict of its own.
        folder: folder of the results; if None ``runs/NAME``, for a dict ``runs/sweep``.
        threads: number of threads; 0: one for each core.
        shard: (i, n) to do only every n-th run, from the i-th on. The last of n processes that share a folder merges
            the results.
        format: ``"csv"`` or ``"hdf5"``, the format of the results; if None, that of results that are there, else CSV.
            Results of the same sweep in another format are converted.

    Returns:
        A row for each run with its keys, ``status``, ``reason``, and the final (``end.axial.force``) and largest
        (``max.axial.force``) value of every column. None if runs of other shards are missing. The table is
        ``results.csv`` or ``results.h5`` in the folder; its ``left_out`` counts the points that the constraints exclude. If the file has ``[bands]``, percentiles of the histories are
        ``bands.csv``.

    Raises:
        ScenarioError: with every fault of the sweep and its scenario.
        ValueError: for another format.
        RuntimeError: before any run, if the folder holds a run, a calibration or a plan, or a file of yours with the name of
            one to write, or cannot be written, or if HDF5 cannot be used; after the runs, for bands of columns that the
            histories lack.
        KeyboardInterrupt: on Ctrl-C. Complete runs stay in the folder, and the next call does the others.
    """
    named_text = _named_text(source, "sweep.toml")
    results, left_out, remarks, no_figure = _core.sweep(*named_text, _folder(folder), threads, *shard, format or "")
    _warn(remarks, no_figure)
    return None if results is None else Sweep(results, left_out)


@explained
def sensitivity(source: Source, folder: Optional[Path] = None, *, threads: int = 0, confidence: float = 0.95) -> Table:
    """Computes how much each key contributes to the spread of results, as ``monograin sensitivity`` does.

    Results that runs lack, that runs took before the end of their programs, or that are the same in every run, give a
    ``RuntimeWarning``, and so do the values and figures of :func:`sweep`.

    Args:
        source: a sweep as for :func:`sweep`, of design ``saltelli`` or ``morris``, with formulas of ``results``.
        folder: folder of the results, as for :func:`sweep`. Runs already in it are not repeated.
        threads: number of threads; 0: one for each core.
        confidence: level of the two-sided bootstrap intervals, between 0 and 1.

    Returns:
        A row for each result and key. Design ``saltelli`` gives the shares of the variance ``first`` and ``total`` with
        the ends of their intervals (Saltelli et al., 2010; Jansen, 1999). Design ``morris`` gives ``mean_size``,
        ``mean`` and ``standard_deviation`` of the elementary effects over the whole range of a key (Morris, 1991). The
        table is ``sensitivity.csv`` in the folder, beside its figure.

    Raises:
        ScenarioError: with every fault of the sweep and its scenario.
        ValueError: before any run, for another design, or a confidence outside of (0, 1).
        RuntimeError: for a formula that cannot be evaluated with the columns of the results, and as for :func:`sweep`.
    """
    named_text = _named_text(source, "sweep.toml")
    table, remarks, no_figure = _core.sensitivity(*named_text, _folder(folder), threads, confidence)
    _warn(remarks, no_figure)
    return Table(table)


class FittedParameter(NamedTuple):
    """A fitted parameter of a scenario, in SI units.

    Attributes:
        value: value of the best fit.
        standard_error: standard error of the linearised fit; nan if the data do not determine the value.
        interval: two-sided confidence interval, from the covariance, the profile or the bootstrap, as chosen by
            ``[fit] intervals``. It may be asymmetric, and may end at a bound.
        bounds: bounds of the search.
        at_bound: ``"lower"`` or ``"upper"`` if the value is at a bound, else None.
        is_determined: True if the data determine the value.
    """

    value: float
    standard_error: float
    interval: tuple[float, float]
    bounds: tuple[float, float]
    at_bound: Optional[str]
    is_determined: bool


class _Result:
    """What calibrations and designs have in common: text, pickling, equality."""

    __slots__ = ("_core",)
    _core: Any

    def __str__(self) -> str:
        text: str = self._core.text
        return text

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), _parts_of(self._core)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return NotImplemented
        return _parts_of(self._core) == _parts_of(other._core)

    def __hash__(self) -> int:
        return hash(self._core.text)


class Calibration(_Result):
    """Result of a calibration: fitted parameters, their uncertainty, and the fit itself.

    It can be pickled and copied. Results are equal if all their parts are. A notebook shows the parameters.
    """

    __slots__ = ("_info",)
    _core: Fitted

    def __init__(self, core: Fitted) -> None:
        self._core = core
        self._info: dict[str, Any] = json.loads(core.json)

    @property
    def parameters(self) -> dict[str, FittedParameter]:
        """The fitted parameters, by their keys."""
        return Named(
            {
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
        )

    @property
    def values(self) -> dict[str, float]:
        """Best values by key, in SI units, as :meth:`monograin.Scenario.replace` takes them."""
        return Named({key: parameter.value for key, parameter in self.parameters.items()})

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance matrix of the parameters in SI units, shape (p, p); nan for parameters that are not determined."""
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
        """Reasons not to trust the fit, with the likely causes; empty for a good fit."""
        return self._core.warnings

    @property
    def scenario(self) -> Scenario:
        """The scenario with the fitted parameters, and the files that it names in memory."""
        return Scenario(self.scenario_text, origin="fitted.toml", files=self._core.scenario_files)

    @property
    def scenario_text(self) -> str:
        """The scenario with the fitted parameters, as ``fitted.toml`` has it; files that it names lie beside that file."""
        return self._core.scenario_text

    @property
    def info(self) -> dict[str, Any]:
        """Content of ``calibration.json``: parameters, statistics, minima, data."""
        return copy.deepcopy(self._info)

    @explained
    def plot(self, *, axes: Union[Axes, Sequence[Axes], None] = None) -> Figure:
        """Draws the data, the fit and its confidence band, in SI units. A notebook shows the figure.

        Args:
            axes: axes of matplotlib to draw into, of several the first; None: those of a new figure, which pyplot does
                not manage.

        Raises:
            ImportError: if matplotlib is not installed.
        """
        from . import _figure

        return _figure.of_fit(self.fit, axes)

    def __repr__(self) -> str:
        values = ", ".join(f"{key} = {value:.5g}" for key, value in self.values.items())
        return f"<Calibration {self._core.name!r}: {values}>"

    def _repr_html_(self) -> str:
        rows = [
            (key, fitted.value, fitted.standard_error, *fitted.interval, "yes" if fitted.is_determined else "no")
            for key, fitted in self.parameters.items()
        ]
        headings = ("parameter", "value", "standard error", "interval from", "to", "is determined")
        return _html.table(f"Calibration {self._core.name}, values in SI units", headings, rows)


@explained
def calibrate(source: Source, folder: Optional[Path] = None, *, confidence: Optional[float] = None) -> Calibration:
    """Fits parameters of a scenario to measured data, as ``monograin calibrate`` does.

    A bad fit, and a figure that cannot be drawn, give a ``RuntimeWarning``.

    Args:
        source: a calibration file (TOML), or a dict of the same structure, whose file names are relative to the current
            folder. In a dict, the scenario may be a :class:`Scenario`, and the ``file`` of data may also be the data: a
            :class:`Run` or :class:`Table`, a ``pandas.DataFrame``, or a dict from headings to arrays, such as
            ``{"displacement[mm]": d, "force[N]": f}``. A nan is a missing cell; columns of words are left out. A
            DataFrame of :meth:`Table.to_pandas` has the units in its ``attrs``; change them with the values.
        folder: folder for the files that the program writes; None: none are written.
        confidence: level of the intervals in (0, 1); None: the level of the file, or 0.95.

    Raises:
        ScenarioError: with every fault of calibration, scenario and data.
        ValueError: for data whose columns are not of equal length.
        RuntimeError: before the fit, if the folder holds a run or a plan, or a file of yours with the name of one to write,
            or cannot be written.
        KeyboardInterrupt: on Ctrl-C; all files of the folder are written then, or none.
    """
    complete, data = _data_as_texts(source)
    core = _core.calibrate(*_named_text(complete, "calibration.toml"), data, _folder(folder), confidence)
    _warn(core.warnings, core.no_figure)
    return Calibration(core)


class Data(NamedTuple):
    """A file of measured data, as a calibration reads it. ``print`` shows the report of ``monograin data``.

    Attributes:
        table: columns x and y with the headings and units of the file: the rows that have both.
        lines: array of shape (rows,): line of each row in the file, from 1.
        remarks: why a calibration would refuse the file, a sentence each.
        text: report: separator, decimal point, columns with units, and branches of loading and unloading.
    """

    table: Table
    lines: NDArray[np.int64]
    remarks: list[str]
    text: str

    def __str__(self) -> str:
        return self.text

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Data) and all(same(a, b) if a is self.lines else a == b for a, b in zip(self, other))

    def __ne__(self, other: object) -> bool:
        return not self == other

    def _repr_html_(self) -> str:
        return self.table._repr_html_()


@explained
def read_data(file: Path, *, x: Union[str, int] = "", y: Union[str, int] = "") -> Data:
    """Reads a file of measured data, such as one of a testing machine, as ``monograin data`` does.

    Separator, decimal point, headings and units are found in the file. The table can be compared with a run if its units are
    SI, and can be the data of :func:`calibrate`, whatever they are.

    Args:
        file: a text file: CSV, or columns between tabs, semicolons or blanks.
        x: heading or number of a column, from 1; empty: the first column of lengths, else the first one of numbers.
        y: heading or number of a column; empty: the first column of forces, else the next one of numbers.

    Raises:
        ScenarioError: if the file cannot be read, is no table, or has no such column; with the place.
        ValueError: if x and y are one column, or have the same heading.
    """
    table, lines, remarks, text = _core.read_data(os.fspath(file), str(x), str(y))
    return Data(Table(table), np.asarray(lines, dtype=np.int64), remarks, text)


class ExpectedErrors(NamedTuple):
    """Expected errors of one fit to the measurements of several programs, in SI units.

    Attributes:
        standard_errors: standard error of every parameter, by its key; nan if the measurements do not determine it.
        covariance: covariance matrix, shape (p, p), in the order of ``standard_errors``; nan for parameters that are
            not determined.
        correlation: correlation matrix, shape (p, p), in the order of ``standard_errors``.
        volume: D-criterion: volume of the confidence ellipsoid over that of the planned programs alone; 1 for the
            planned programs, nan if their volume is infinite.
        relative_variances: A-criterion: sum of the variances of the parameters, each over its value squared; inf if a
            parameter is not determined.
        log_determinant: natural logarithm of the determinant of the relative covariance; inf if a parameter is not
            determined.
    """

    standard_errors: dict[str, float]
    covariance: NDArray[np.float64]
    correlation: NDArray[np.float64]
    volume: float
    relative_variances: float
    log_determinant: float

    @property
    def is_determined(self) -> dict[str, bool]:
        """True for each parameter that the measurements determine, by its key."""
        return Named({key: bool(np.isfinite(error)) for key, error in self.standard_errors.items()})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ExpectedErrors) and same(tuple(self), tuple(other))

    def __ne__(self, other: object) -> bool:
        return not self == other


class Design(_Result):
    """Expected errors of the parameters from a planned experiment, alone and with each candidate program.

    It can be pickled and copied. Results are equal if all their parts are. A notebook shows the errors.
    """

    __slots__ = ("_table",)
    _core: Designed

    def __init__(self, core: Designed) -> None:
        self._core = core
        self._table = Table(core.table)

    @property
    def values(self) -> dict[str, float]:
        """Values of the parameters that the plan assumes as true, by key, in SI units."""
        count = len(self._table) // (len(self._core.candidates) + self._core.has_planned)
        return Named(zip(self._table["key"][:count].tolist(), self._table["value"][:count].tolist()))

    @property
    def planned(self) -> Optional[ExpectedErrors]:
        """Errors with the planned programs alone; None if no program is planned and no parameter has a prior."""
        return self._errors(0) if self._core.has_planned else None

    @property
    def candidates(self) -> dict[str, ExpectedErrors]:
        """Errors with the planned programs and one candidate, by the candidate's name."""
        first = int(self._core.has_planned)
        return Named({name: self._errors(first + k) for k, name in enumerate(self._core.candidates)})

    @property
    def best_by_volume(self) -> Optional[str]:
        """Name of the D-optimal candidate, with the least volume; None if no candidate determines all parameters."""
        return self._core.best_by_volume

    @property
    def best_by_variances(self) -> Optional[str]:
        """Name of the A-optimal candidate, with the least sum of relative variances; None as in ``best_by_volume``."""
        return self._core.best_by_variances

    @property
    def notes(self) -> dict[str, list[str]]:
        """Remarks on the run of each program, by its name."""
        return Named(zip(self._core.programs, self._core.notes))

    @property
    def table(self) -> Table:
        """A row for each parameter of the planned programs and of each candidate, as ``errors.csv`` holds it."""
        return self._table

    def _errors(self, block: int) -> ExpectedErrors:
        values = self.values
        rows = slice(block * len(values), (block + 1) * len(values))
        errors = self._table["standard_error"][rows]
        correlation: NDArray[np.float64] = np.column_stack([self._table[f"correlation({key})"][rows] for key in values])
        return ExpectedErrors(
            Named(zip(values, errors.tolist())),
            errors[:, None] * correlation * errors,
            correlation,
            *(float(self._table[name][rows][0]) for name in ("volume", "relative_variances", "log_determinant")),
        )

    def __repr__(self) -> str:
        return f"<Design {self._core.name!r}: {', '.join(self._core.programs)}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self._table._repr_html_()}"


@explained
def design(source: Source, folder: Optional[Path] = None) -> Design:
    """Computes the expected errors of the parameters from a planned experiment, as ``monograin design`` does.

    The covariance is the inverse of the Fisher information (Fedorov, 1972). This assumes that the law is right and
    nearly linear within the errors, and that the noise is known. A figure that cannot be drawn gives a
    ``RuntimeWarning``.

    Args:
        source: a plan (TOML), or a dict of the same structure: scenario, free parameters, programs with the noise of
            their measurements.
        folder: folder for the files that the program writes; None: none are written.

    Raises:
        ScenarioError: with every fault of plan and scenario, or if the noise of a measured row is zero.
        RuntimeError: before the computation, if the folder holds a run or a calibration, or a file of yours with the name
            of one to write, or cannot be written.
        KeyboardInterrupt: on Ctrl-C; all files of the folder are written then, or none.
    """
    core = _core.design(*_named_text(source, "design.toml"), _folder(folder))
    _warn([], core.no_figure)
    return Design(core)


class CurveDifference(NamedTuple):
    """Error measures of a column against the same column of a reference.

    Attributes:
        y: heading of the column.
        linf: largest difference over the largest magnitude of the reference.
        linf_at: x of the largest difference.
        l2: root of the integral of the squared difference over x, over the same root for the reference itself.
        area_error: root of the integral of the squared difference over x, over the integral of the magnitude of the
            reference (Edmans and Sinka, eq. 7); a length x counts in units of ``R0``, any other x with a unit in
            units of its range.
        peak_error: largest difference over the magnitude of the reference at its largest x (Edmans and Sinka, eq. 8).
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
    """A column of the reference that could not be compared, or whose words differ.

    Attributes:
        column: heading of the column.
        problem: continues a sentence that begins with the heading: ``"is missing"``.
    """

    column: str
    problem: str


class Comparison(NamedTuple):
    """Differences of two tables.

    Attributes:
        curves: one :class:`CurveDifference` for each column of numbers that both tables have.
        gaps: columns that are missing, not covered, or whose words differ.
    """

    curves: list[CurveDifference]
    gaps: list[Gap]

    def _repr_html_(self) -> str:
        caption = "; ".join(f"{gap.column} {gap.problem}" for gap in self.gaps) or "no gaps"
        return _html.table(caption, CurveDifference._fields, self.curves)


@explained
def compare(
    a: Curves,
    b: Curves,
    *,
    x: str = "time",
    y: str = "",
) -> Comparison:
    """Compares b with the reference a, as ``monograin compare`` does.

    Args:
        a: the reference: a run, a table, the folder of a run, a CSV file, or arrays in a dict or a DataFrame, as for
            :meth:`Table.from_columns`. Columns of different units are a gap: arrays that are compared with a run need SI
            units, ``"axial.force[N]"``.
        b: what is compared with the reference, as for ``a``.
        x: name of the column for the abscissa; empty: the first column.
        y: name of the column to compare; empty: every column, and the events if both are runs or their folders.

    Raises:
        RuntimeError: if the reference lacks a column that was named, or a file cannot be read. Curves without a common
            range are no error but a gap.
    """
    curves, gaps = _core.compare_tables(_history(a, "a")._core, _history(b, "b")._core, x, y)
    events_a, events_b = _events(a), _events(b)
    if not y and events_a is not None and events_b is not None:
        more_curves, more_gaps = _core.compare_events(events_a._core, events_b._core)
        curves, gaps = curves + more_curves, gaps + more_gaps
    return Comparison([CurveDifference(*curve) for curve in curves], [Gap(*gap) for gap in gaps])


def _parts_of(core: Any) -> dict[str, Any]:
    """Returns the attributes of a result of the compiled module."""
    names = vars(core) if isinstance(core, types.SimpleNamespace) else vars(type(core))
    values = {name: getattr(core, name) for name in names if not name.startswith("_")}
    return {name: Table(value) if isinstance(value, _core.Table) else value for name, value in values.items()}


def _restored(kind: Any, parts: dict[str, Any]) -> Any:
    core = {name: value._core if isinstance(value, Table) else value for name, value in parts.items()}
    return kind(types.SimpleNamespace(**core))


def _warn(remarks: Sequence[str], no_figure: str) -> None:
    """Warns the caller of a study: that its figure cannot be drawn, and of each remark."""
    for remark in ([f"no figure: {no_figure}"] if no_figure else []) + list(remarks):
        warnings.warn(remark, RuntimeWarning, stacklevel=4)


def _folder(folder: Optional[Path]) -> str:
    return "" if folder is None else os.fspath(folder)


def _named_text(source: Source, name: str) -> tuple[str, Optional[str]]:
    """Returns the name of a study in messages, and its text; None for a file."""
    if isinstance(source, Mapping):
        return name, _toml.document(_plain(source))
    return os.fspath(source), None


def _plain(value: Any) -> Any:
    """Returns a study with the dict of a :class:`Scenario` in its place."""
    if isinstance(value, Scenario):
        if value.files is not None:
            raise ValueError(
                f"the scenario has {', '.join(value.files)} in memory; expected files on disk, so write them, and make the "
                "scenario anew with its text and their folder in origin"
            )
        return value.to_dict()
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value


def _data_as_texts(source: Source) -> tuple[Source, dict[str, str]]:
    """Returns a calibration whose data in memory have names, and the texts of these data by name."""
    data = source.get("data") if isinstance(source, Mapping) else None
    texts: dict[str, str] = {}

    def named(curve: Any, name: str) -> Any:
        values = curve.get("file") if isinstance(curve, Mapping) else None
        if values is None or isinstance(values, (str, os.PathLike)):
            return curve
        texts[name] = _csv(values)
        return {**curve, "file": name}

    if isinstance(source, Mapping) and isinstance(data, (list, tuple)):
        source = {**source, "data": [named(curve, f"data-{k + 1}.csv") for k, curve in enumerate(data)]}
    elif isinstance(source, Mapping) and data is not None:
        source = {**source, "data": named(data, "data.csv")}
    return source, texts


def _csv(data: Curves) -> str:
    """Returns the numbers of a table, or of arrays, as a CSV text."""
    table = _history(data, "data")
    if isinstance(data, (Run, Table)):
        return table._core.csv()
    columns = [part for part in table._core.parts() if not part[2]]
    headings = [f"{name}[{unit}]" if unit else name for name, unit, _, _ in columns]
    quoted = ['"' + heading.replace('"', '""') + '"' for heading in headings]
    rows = (["" if np.isnan(value) else repr(float(value)) for value in row] for row in zip(*(c[3] for c in columns)))
    return "".join(",".join(cells) + "\n" for cells in (quoted, *rows))


def _history(source: Curves, argument: str) -> Table:
    """Returns the table of a run, of arrays or of a file. Messages name the argument."""
    if isinstance(source, Run):
        return source.history
    if isinstance(source, Table):
        return source
    if hasattr(source, "keys"):
        return Table.from_columns(source)
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"{argument}: expected a run, a table, a file, or arrays by name, not {shown(source)}")
    return Table.read_csv(os.path.join(source, "history.csv") if os.path.isdir(source) else source)


def _events(source: Curves) -> Optional[Table]:
    if isinstance(source, Run):
        return source.events
    if not isinstance(source, (str, os.PathLike)) or not os.path.isdir(source):
        return None
    return Table.read_csv(os.path.join(source, "events.csv"))


def _number(value: Optional[float]) -> float:
    return float("nan") if value is None else value


def _matrix(rows: list[list[Optional[float]]]) -> NDArray[np.float64]:
    return np.array([[_number(value) for value in row] for row in rows])

"""Figures of runs, drawn with matplotlib."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, NamedTuple, Optional, Sequence, Union

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .tables import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .runs import Run

# Colours of Okabe and Ito, which colour-blind readers can distinguish.
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_STYLES = {"loading": "-", "unloading": "--", "reloading": ":"}
# Sparse filled marks of the curves after the first one, which differ in grey print, too.
_CURVE_MARKS = ("", "o", "^", "s", "D", "p", "v")
# Each event has the next symbol, colour and size. Events at one point remain visible, as their sizes differ.
_SYMBOLS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "p", "h")
_SIZES = (5.0, 7.0, 9.0)
# Begin of the name that the marks of an event have within a figure.
_EVENT = "event "
# Events that are not marked, because the curve itself shows the corners of the program.
_PROGRAM_EVENTS = ("step-end", "until-met")


class _Panel(NamedTuple):
    label: str
    columns: list[tuple[str, str]]  # legend and column of each curve
    scale: float  # divides the values
    is_area: bool = False  # true: the panel shows pi times the square of the column


class _Mark(NamedTuple):
    symbol: str
    colour: str
    size: float


class _Sheet(NamedTuple):
    label: str
    column: str  # column of the abscissa
    scale: float
    panels: list[_Panel]


class ShownFigure(Figure):  # type: ignore[misc]
    """A figure that a notebook shows, though pyplot does not manage it."""

    def _repr_png_(self) -> bytes:
        content = io.BytesIO()
        self.savefig(content, format="png")
        return content.getvalue()


def of_run(
    run: Run,
    columns: Union[str, Sequence[str], None],
    x: Optional[str],
    axes: Union[Axes, Sequence[Axes], None],
    label: str,
) -> Figure:
    """Draws a run; see :meth:`monograin.Run.plot`."""
    sheet = _of_walls(run.history) or _of_body(run.history)
    path = run[sheet.column] if sheet and len(run) > 0 else run["time"]
    if columns is not None:
        names = [columns] if isinstance(columns, str) else list(columns)
        panels = [_Panel(_with_unit(run.history, name), [("", name)], 1.0) for name in names]
        sheet = _in_si(run.history, x or (sheet.column if sheet else "time"), panels)
    elif sheet and x is not None:
        sheet = _in_si(run.history, x, sheet.panels)
    panels = [panel for panel in sheet.panels if _is_defined(run.history, panel)] if sheet else []
    if sheet is None or not panels or len(run) < 2:
        raise ValueError("the run has no curve to draw")
    places = _places(axes, len(panels))
    figure: Figure = places[0].figure
    marks = _marks(figure, run.events)
    for place, panel in zip(places, panels):
        _draw(place, run, sheet, panel, _phases(path), marks, label)
    return figure


def of_fit(fit: Table, axes: Union[Axes, Sequence[Axes], None]) -> Figure:
    """Draws data, fit and confidence band; see :meth:`monograin.Calibration.plot`."""
    x, y = (fit[name] for name in fit.columns[:2])
    place = _places(axes, 1)[0]
    place.plot(x, y, "o", color="0.5", markersize=3, markerfacecolor="none", label="data")
    curves = fit["curve"] if "curve" in fit else np.zeros(len(fit))
    for k, curve in enumerate(np.unique(curves)):
        rows = curves == curve
        place.plot(x[rows], fit["fit"][rows], color=_COLOURS[0], label="fit" if k == 0 else None)
        place.fill_between(x[rows], fit["band_lower"][rows], fit["band_upper"][rows], color=_COLOURS[0], alpha=0.2)
    place.set_xlabel(_with_unit(fit, fit.columns[0]))
    place.set_ylabel(_with_unit(fit, fit.columns[1]))
    place.legend(fontsize="small")
    figure: Figure = place.figure
    return figure


def _places(axes: Union[Axes, Sequence[Axes], None], count: int) -> list[Axes]:
    """Returns axes for some panels: those that are given, or those of a new figure."""
    if axes is None:
        rows = (count + 1) // 2
        figure = ShownFigure(figsize=(8.0 if count > 1 else 5.0, 3.2 * rows), layout="constrained")
        made = [figure.add_subplot(rows, min(2, count), place + 1) for place in range(count)]
        for place in made:
            # Numbers in metres would overlap.
            place.ticklabel_format(scilimits=(-2, 5))
        return made
    places = list(np.ravel(np.asarray(axes, dtype=object)))
    for place in places:
        if not hasattr(place, "plot"):
            raise TypeError(f"axes: expected axes of matplotlib, not {place!r}")
    if len(places) < count:
        raise ValueError(f"axes: {len(places)} for {count} panels; expected one for each")
    return places


def _draw(
    axes: Axes,
    run: Run,
    sheet: _Sheet,
    panel: _Panel,
    phases: list[tuple[str, slice]],
    marks: dict[str, _Mark],
    label: str,
) -> None:
    x = run[sheet.column] / sheet.scale
    # Curves that the axes show already keep their colours.
    used = len({line.get_color() for line in axes.lines if line.get_linestyle() != "None"})
    for k, (legend, column) in enumerate(panel.columns):
        y = _values(run.history, panel, column)
        colour = _COLOURS[(used + k) % len(_COLOURS)]
        name = ": ".join(filter(None, (label, legend)))
        line = {"color": colour, "marker": _CURVE_MARKS[(used + k) % len(_CURVE_MARKS)], "markersize": 3.5}
        for i, (phase, piece) in enumerate(phases):
            text = name if i == 0 else None
            axes.plot(x[piece], y[piece], linestyle=_STYLES[phase], markevery=0.15, label=text, **line)
    for name, rows in _events(run.events).items():
        points = [
            (run.events[sheet.column][row] / sheet.scale, _values(run.events, panel, column)[row])
            for _, column in panel.columns
            # Events lack some columns of a history, such as the number of a row.
            if sheet.column in run.events and column in run.events
            for row in rows
            if _concerns(run.events, row, column)
        ]
        if points:
            text = None if name in _marks_in([axes]) else name
            symbol, colour, size = marks[name]
            style = {"marker": symbol, "color": colour, "markersize": size, "linestyle": "None"}
            axes.plot(*zip(*points), **style, markerfacecolor="none", label=text, gid=_EVENT + name)
    axes.set_xlabel(sheet.label)
    axes.set_ylabel(panel.label)
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend(fontsize="small")


def _marks(figure: Figure, events: Table) -> dict[str, _Mark]:
    """Returns the mark of each event of a run, equal in all panels, and the marks that the figure has already."""
    marks = _marks_in(figure.axes)
    for name in _events(events):
        count = len(marks)
        colour = _COLOURS[-1 - count % len(_COLOURS)]
        marks.setdefault(name, _Mark(_SYMBOLS[count % len(_SYMBOLS)], colour, _SIZES[count % len(_SIZES)]))
    return marks


def _marks_in(places: Sequence[Axes]) -> dict[str, _Mark]:
    """Returns the mark of each event that axes show."""
    lines = [line for place in places for line in place.lines if str(line.get_gid()).startswith(_EVENT)]
    return {
        line.get_gid().removeprefix(_EVENT): _Mark(line.get_marker(), line.get_color(), line.get_markersize())
        for line in lines
    }


def _in_si(history: Table, x: str, panels: list[_Panel]) -> _Sheet:
    return _Sheet(_with_unit(history, x), x, 1.0, panels)


def _with_unit(history: Table, name: str) -> str:
    """Returns the label of a column. Refuses a column of words."""
    if history[name].dtype.kind != "f":
        raise ValueError(f"column {name!r} holds words; expected a column of numbers")
    plain = name.partition("[")[0]
    return f"{plain} [{history.units[plain]}]" if plain in history.units else name


def _of_walls(history: Table) -> Optional[_Sheet]:
    """Force, pressure, area and apparent radius over the displacement of the first contact class that moves."""
    classes = [name[: -len(".displacement")] for name in history.columns if name.endswith(".displacement")]
    if not classes:
        return None
    driven = next((name for name in classes if np.ptp(history[f"{name}.displacement"]) > 0.0), classes[0])
    radius, modulus, stress = (_scale(history, key) for key in ("R0", "E", "Y"))
    pressure_scale, pressure_unit = (stress, "Y") if stress else (modulus, "E")
    panels = [
        _Panel(
            "Force $F/(E R_0^2)$" if radius and modulus else "Force $F$ [N]",
            _contacts(history, classes, "force"),
            modulus * radius**2 if radius and modulus else 1.0,
        ),
        _Panel(
            f"Mean pressure $p/{pressure_unit}$" if pressure_scale else "Mean pressure $p$ [Pa]",
            _contacts(history, classes, "pressure"),
            pressure_scale or 1.0,
        ),
        _Panel(
            r"Contact area $A_c/(\pi R_0^2)$" if radius else "Contact area $A_c$ [m$^2$]",
            _contacts(history, classes, "contact_radius_deformed") or _contacts(history, classes, "contact_radius"),
            np.pi * radius**2 if radius else 1.0,
            is_area=True,
        ),
        _Panel(
            "Apparent radius $R/R_0$" if radius else "Apparent radius $R$ [m]",
            [("", "apparent_radius")] if "apparent_radius" in history else [],
            radius or 1.0,
        ),
    ]
    label = r"Displacement $\delta_o/R_0$" if radius else r"Displacement $\delta_o$ [m]"
    return _Sheet(label, f"{driven}.displacement", radius or 1.0, panels)


def _of_body(history: Table) -> Optional[_Sheet]:
    """Quantities of a packing over its packing fraction, or of a material point over its axial strain."""
    modulus = _scale(history, "E") or 1.0
    pressure = _scale(history, "yield_pressure") or 1.0
    sheets = (
        _Sheet(
            r"Packing fraction $\Phi$",
            "packing_fraction",
            1.0,
            [
                _Panel(r"Stress $\sigma/E$", [("", "stress")], modulus),
                _Panel("Strain $e$", [("", "strain")], 1.0),
                _Panel("Coordination number $Z$", [("", "coordination_number")], 1.0),
                _Panel("Plastic fraction $f_p$", [("", "plastic_fraction")], 1.0),
            ],
        ),
        _Sheet(
            "Axial strain",
            "strain_axial",
            1.0,
            [
                _Panel(r"Axial stress $\sigma_a/\sigma_{y0}$", [("", "stress_axial")], pressure),
                _Panel(r"Mean stress $p/\sigma_{y0}$", [("", "p")], pressure),
                _Panel(r"Deviatoric stress $q/\sigma_{y0}$", [("", "q")], pressure),
                _Panel(r"Relative density $\rho$", [("", "relative_density")], 1.0),
            ],
        ),
    )
    return next((sheet for sheet in sheets if sheet.column in history), None)


def _contacts(history: Table, classes: list[str], quantity: str) -> list[tuple[str, str]]:
    return [(name, f"{name}.{quantity}") for name in classes if f"{name}.{quantity}" in history]


def _scale(history: Table, key: str) -> Optional[float]:
    text = history.header.get(key)
    return float(text) if text and float(text) > 0.0 else None


def _values(table: Table, panel: _Panel, column: str) -> NDArray[np.float64]:
    values: NDArray[np.float64] = table[column]
    return (np.pi * values**2 if panel.is_area else values) / panel.scale


def _is_defined(history: Table, panel: _Panel) -> bool:
    return any(column in history and np.isfinite(history[column]).any() for _, column in panel.columns)


def _events(events: Table) -> dict[str, list[int]]:
    rows: dict[str, list[int]] = {}
    if len(events) > 0:
        for row, name in enumerate(events["event"]):
            if name not in _PROGRAM_EVENTS:
                rows.setdefault(str(name), []).append(row)
    return rows


def _concerns(events: Table, row: int, column: str) -> bool:
    """True if an event belongs to the contact class of a column. A curve of the particle shows all."""
    contact, point, _ = column.partition(".")
    return not point or contact in str(events["class"][row]).split("/")


def _phases(x: NDArray[np.float64]) -> list[tuple[str, slice]]:
    """Splits the path into loading (beyond the largest x so far), unloading and reloading. Neighbours share a row."""
    pieces: list[tuple[str, slice]] = []
    largest, phase = x[0], "loading"
    for row in range(1, len(x)):
        if x[row] != x[row - 1]:
            is_back = x[row] < x[row - 1]
            phase = "unloading" if is_back else "loading" if x[row] > largest * (1.0 + 1e-12) else "reloading"
        largest = max(largest, x[row])
        if pieces and pieces[-1][0] == phase:
            pieces[-1] = (phase, slice(pieces[-1][1].start, row + 1))
        else:
            pieces.append((phase, slice(row - 1, row + 1)))
    return pieces

"""Figures of runs, drawn with matplotlib."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Union

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .tables import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .runs import Run

# Colours of Okabe and Ito, which colour-blind readers can distinguish.
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
# Curves of the whole particle, beside curves of contacts in the colours above.
_GREYS = ("#303030", "#7A7A7A", "#A8A8A8")
_STYLES = {"loading": "-", "unloading": "--", "reloading": ":"}
# Sparse filled marks of the curves after the first one, which differ in grey print, too.
_CURVE_MARKS = ("", "o", "^", "s", "D", "p", "v")
# Symbols and colours of events, as in the figures of gnuplot (src/figure/legend.cpp): the place of a name in the list
# gives both; other names share the symbol after the last.
_EVENTS = (
    *("yield", "load-reversal", "reload", "contact-made", "contact-lost", "fully-plastic", "pull-off", "peel", "stick"),
    *("growth-on", "growth-off", "zero-porosity", "dent-touched", "low-compressibility", "impingement", "jamming"),
    *("plastic-softening", "force-extremum", "follow", "retreat", "secondary-onset", "segment-change", "plastic-off"),
    *("transition", "caps-intersect", "stiffening", "limit", "full", "singular-growth", "volume-limit", "radius-limit"),
    *("density-limit", "loss-of-uniqueness", "poisson-half", "cap-centre-tensile", "cap-axis-nonpositive"),
)
_OPEN_SYMBOLS = ("o", "s", "^", "v", "D", "p", "x", "+", "$*$")
_FILLED_SYMBOLS = ("o", "s", "^", "v", "D", "p")
_EVENT_COLOURS = ("#000000", "#909090", "#8B0000")
_EVENT_SIZE = 6.0
# Events that are not marked, because the curve itself shows the corners of the program.
_PROGRAM_EVENTS = ("step-end", "until-met")
# Size of a panel, and of the texts of a legend below all panels [inch].
_PANEL_HEIGHT = 3.2
_LEGEND_LINE, _LEGEND_LETTER, _LEGEND_SAMPLE = 0.2, 0.085, 0.6


class _Panel(NamedTuple):
    label: str
    columns: list[tuple[str, str]]  # legend and column of each curve
    scale: float  # divides the values
    is_area: bool = False  # true: the panel shows pi times the square of the column


class _Sheet(NamedTuple):
    label: str
    column: str  # column of the abscissa
    scale: float
    panels: list[_Panel]


class ShownFigure(Figure):  # type: ignore[misc]
    """A figure that a notebook shows, though pyplot does not manage it. One legend stands below all panels."""

    def show_legend(self, entries: dict[str, Any]) -> None:
        """Replaces the legend by one with these entries, and makes the figure as much taller as it needs."""
        for legend in list(self.legends):
            legend.remove()
        engine = self.get_layout_engine()
        left, bottom, width, height = engine.get()["rect"]
        panels = self.get_figheight() * height
        entry = _LEGEND_SAMPLE + _LEGEND_LETTER * max(map(len, entries), default=0)
        columns = max(1, min(len(entries), int(self.get_figwidth() / entry)))
        strip = _LEGEND_LINE * (-(-len(entries) // columns) + 1) if len(entries) > 1 else 0.0
        self.set_figheight(panels + strip)
        engine.set(rect=(left, strip / (panels + strip), width, panels / (panels + strip)))
        if len(entries) > 1:
            self.legend(entries.values(), entries.keys(), loc="lower center", ncol=columns, fontsize="small")

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
    for place, panel in zip(places, panels):
        _draw(place, run, sheet, panel, _phases(path), label)
    _show_legend(figure, places)
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
        figure = ShownFigure(figsize=(8.0 if count > 1 else 5.0, _PANEL_HEIGHT * rows), layout="constrained")
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
    label: str,
) -> None:
    x = run[sheet.column] / sheet.scale
    # Curves that the axes show already keep their colours.
    used = len({line.get_color() for line in axes.lines if line.get_linestyle() != "None"})
    shows_contacts = any(legend for shown in sheet.panels for legend, _ in shown.columns)
    for k, (legend, column) in enumerate(panel.columns):
        colours = _GREYS if shows_contacts and not legend else _COLOURS
        y = _values(run.history, panel, column)
        colour = colours[(used + k) % len(colours)]
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
            axes.plot(*zip(*points), **_mark(name), linestyle="None", label=name)
    axes.set_xlabel(sheet.label)
    axes.set_ylabel(panel.label)


def _mark(event: str) -> dict[str, Any]:
    """Returns symbol, colour and size of an event."""
    place = _EVENTS.index(event) if event in _EVENTS else len(_EVENTS)
    turn, symbol = divmod(place, len(_OPEN_SYMBOLS) + len(_FILLED_SYMBOLS))
    colour = _EVENT_COLOURS[turn % len(_EVENT_COLOURS)]
    look = {"color": colour, "markersize": _EVENT_SIZE}
    if symbol < len(_OPEN_SYMBOLS):
        return {**look, "marker": _OPEN_SYMBOLS[symbol], "markerfacecolor": "none"}
    return {**look, "marker": _FILLED_SYMBOLS[symbol - len(_OPEN_SYMBOLS)]}


def _show_legend(figure: Figure, places: Sequence[Axes]) -> None:
    """Shows one legend of all panels, curves before events: below them, or in the first panel of another's figure."""
    is_own = isinstance(figure, ShownFigure)
    found = [item for place in (figure.axes if is_own else places) for item in zip(*place.get_legend_handles_labels())]
    found.sort(key=lambda item: item[1] in _EVENTS)
    entries: dict[str, Any] = {}
    for handle, label in found:
        entries.setdefault(label, handle)
    if is_own:
        figure.show_legend(entries)
    elif len(entries) > 1:
        places[0].legend(entries.values(), entries.keys(), fontsize="small")


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
    """True if an event belongs to what a column shows: to its contact class, or to the particle."""
    contact, point, _ = column.partition(".")
    return (contact if point else "") in str(events["class"][row]).split("/")


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

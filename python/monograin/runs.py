"""Scenarios and runs."""

from __future__ import annotations

import html
import json
import os
import tomllib
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Iterator, Mapping, Optional, Sequence, Union

from numpy.typing import NDArray

from . import _core, _toml
from ._inputs import explained, texts
from ._optional import Axes, DataFrame, Figure
from .errors import SolverError
from .tables import Table

Path = Union[str, "os.PathLike[str]"]

_FILES = ("history.csv", "events.csv", "run.json")


class Scenario:
    """A checked scenario: a particle, its material, a contact law, and walls with their program.

    Args:
        source: TOML text as in a scenario file, or a dict of the same structure. In a dict, a str is a text as in a
            file (``"30 MPa"``), a float is a number in SI units, tables are dicts and arrays of tables are lists of
            dicts.
        origin: name of the file that the text is from, in messages. Its stem names the scenario; file names in the
            scenario are relative to its folder.
        overrides: ``key=value`` texts, as for the option ``--set`` of the program.
        files: texts of the files that the scenario names, by these names; no file is read then.

    Raises:
        ScenarioError: with every fault of the scenario.
        TypeError: for the name of a file or of a ready scenario instead of a text.
        ValueError: for a name in ``files`` that the scenario does not have.

    A scenario never changes, whatever the working directory later is. It can be pickled, and thus be sent to other
    processes. Scenarios are equal if all their keys and the files that they name have the same content; comments, names
    and places of files, and whether values were replaced, do not count.
    """

    __slots__ = ("_core",)
    _core: _core.Scenario

    @explained
    def __init__(
        self,
        source: Union[str, Mapping[str, Any]],
        *,
        origin: Path = "scenario.toml",
        overrides: Iterable[str] = (),
        files: Optional[Mapping[str, str]] = None,
    ) -> None:
        is_name = isinstance(source, str) and source.strip() and not set("\n=[") & set(source)
        if is_name or isinstance(source, os.PathLike):
            raise TypeError(
                f"source: {str(source)!r} is no TOML text; Scenario.load reads files, and monograin.scenario has ready scenarios"
            )
        if isinstance(overrides, str):
            raise TypeError(f"overrides: expected a list of texts, such as [{overrides!r}], not one str")
        text = source if isinstance(source, str) else _toml.document(source)
        changes = list(overrides)
        known = None if files is None else texts(files, "files")
        for name in known or ():
            if not any(written in place for place in (text, *changes) for written in (name, _toml.text_of(name)[1:-1])):
                raise ValueError(f"files: the scenario names no file {name!r}")
        self._core = _parsed(text, os.fspath(origin), changes, known)

    @classmethod
    @explained
    def load(cls, path: Path) -> Scenario:
        """Reads and checks a scenario file.

        Raises:
            ScenarioError: with every fault of the scenario, or if the file cannot be read.
        """
        scenario = cls.__new__(cls)
        scenario._core = _core.Scenario.read(os.path.abspath(path))
        return scenario

    @explained
    def replace(self, values: Mapping[str, Any]) -> Scenario:
        """Returns this scenario with other values of some keys.

        Args:
            values: mapping from the path of a key, such as ``"material.yield_stress"`` or
                ``"loading.steps[0].displacement"``, to its value: a str with a unit, a float in SI units, a bool, a
                list or a dict.

        Raises:
            ScenarioError: with every fault of the new scenario.
            ValueError, TypeError: for values that no scenario can have, such as nan.
        """
        overrides = self.overrides
        for key, value in values.items():
            overrides = _core.with_override(overrides, f"{key}={_toml.text_of(value, key)}")
        return _made(_Source(self.text, self.origin, tuple(overrides), self.files))

    @property
    def name(self) -> str:
        """Name of the file, without folder and extension."""
        return self._core.name

    @property
    def title(self) -> str:
        """Title in the scenario; empty if it has none."""
        return self._core.title

    @property
    def model(self) -> str:
        """Name of the contact law, one of :func:`monograin.models`."""
        return self._core.model

    @property
    def text(self) -> str:
        """The scenario as TOML text, without the values that were replaced; :meth:`to_toml` has them."""
        return self._core.text

    def to_toml(self) -> str:
        """Returns the scenario as TOML text, with the values that were replaced, and absolute names of files.

        Comments are lost if there are such values or files. Names of :attr:`files` in memory stay as they are.
        """
        return self._core.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """Returns the scenario as a dict, as :meth:`to_toml` has it and the constructor takes it."""
        return tomllib.loads(self.to_toml())

    @property
    def origin(self) -> str:
        """Absolute path of the file that the text is from, or that a text in memory would have."""
        return self._core.origin

    @property
    def overrides(self) -> list[str]:
        """Values that were replaced, as ``key=value`` texts in the order of the replacements."""
        return self._core.overrides

    @property
    def files(self) -> Optional[dict[str, str]]:
        """Texts of the files that the scenario names, if it has them in memory; None: they are read beside the origin.

        A dict of a study takes no scenario with files in memory.
        """
        return self._core.files

    def run(self, *, check: bool = True) -> Run:
        """Runs the scenario. Other threads continue during the run.

        Args:
            check: True to raise an error if the solver gives up. If False, the status of the run is then ``"failed"``.

        Raises:
            SolverError: if the solver gives up and ``check`` is True; the error has the run up to there.
            ScenarioError: if the programs of the walls are inconsistent.
            KeyboardInterrupt: on Ctrl-C, in the main thread of Python.
        """
        return checked(Run(self._core.run(), lambda: self), check)

    def prepare(self, keys: Iterable[str]) -> Prepared:
        """Prepares many runs with different values of some keys; the scenario's text is read once.

        Args:
            keys: paths of keys whose values are numbers, such as ``"material.yield_stress"``.

        Raises:
            ScenarioError: if the scenario lacks a key, a key takes no number, or a key is listed twice.
            ValueError: without keys.
        """
        prepared: Prepared = Prepared(self, keys)
        return prepared

    def _content(self) -> str:
        return json.dumps(tomllib.loads(self._core.content()), sort_keys=True)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def __reduce__(self) -> tuple[Any, ...]:
        return (_made, (_Source.of(self),))

    def __repr__(self) -> str:
        replaced = "".join(f", {text}" for text in self.overrides)
        return f"<Scenario {self.name!r}, model {self.model}{replaced}>"


class _Record:
    """A run that was read, with the attributes of ``_core.Run``."""

    def __init__(self, text: str, history: _core.Table, events: _core.Table) -> None:
        info = json.loads(text)
        self._text = text
        self.history = history
        self.events = events
        self.status: str = info["status"]
        self.message: str = info["message"]
        self.limit: str = info["limit"] or ""
        self.warnings: list[str] = info["warnings"]

    def json(self) -> str:
        return self._text

    def save(self, folder: str) -> None:
        texts = (self.history.csv(), self.events.csv(), self._text)
        _core.save_run(folder, dict(zip(_FILES, texts)))


class Run:
    """A recorded run: its curves, its events, and how it ended.

    ``run["axial.force"]`` is a column of the history, see :class:`monograin.Table`. ``len(run)`` is its number of rows,
    and iteration yields its rows; ``in`` and ``keys`` are about its columns. A run can be pickled and copied. Runs are
    equal if their scenarios, ends and tables are; the name of the scenario does not count. A notebook shows the first
    and the last rows.
    """

    __slots__ = ("_core", "_scenario", "_history", "_events")

    def __init__(self, core: Union[_core.Run, _Record], scenario: Callable[[], Scenario]) -> None:
        self._core = core
        self._scenario = scenario
        self._history = Table(core.history)
        self._events = Table(core.events)

    @classmethod
    @explained
    def load(cls, folder: Path) -> Run:
        """Reads a run from the files that :meth:`save` or ``monograin run`` has left.

        Its ``scenario`` is made anew from ``run.json``, with the files that it names, when it is asked for.

        Raises:
            FileNotFoundError: if the folder lacks a file of a run.
            ValueError: if ``run.json`` is incomplete or damaged.
            RuntimeError: if ``history.csv`` or ``events.csv`` is not a table.
        """
        history, events = (Table.read_csv(os.path.join(folder, name)) for name in _FILES[:2])
        file = os.path.join(folder, _FILES[2])
        try:
            with open(file, encoding="utf-8") as stream:
                text = stream.read()
            core = _Record(text, history._core, events._core)
            recorded = json.loads(text)["scenario"]
            files = {entry["name"]: entry["text"] for entry in recorded["files"].values()}
            source = _Source(recorded["text"], f"{recorded['name']}.toml", tuple(recorded["overrides"]), files or None)
        except (KeyError, TypeError, json.JSONDecodeError) as error:
            raise ValueError(f"{file}: incomplete or damaged; run the scenario again") from error
        return cls(core, source)

    def __reduce__(self) -> tuple[Any, ...]:
        scenario = self._scenario if isinstance(self._scenario, _Source) else _Source.of(self.scenario)
        return (_of_parts, (self._core.json(), self.history, self.events, scenario))

    @property
    def scenario(self) -> Scenario:
        """The scenario that was run."""
        return self._scenario()

    @property
    def status(self) -> str:
        """``"complete"``, ``"stopped"`` (the run left the domain of its model) or ``"failed"`` (the solver gave up)."""
        return self._core.status

    @property
    def message(self) -> str:
        """Why the run stopped or failed; empty if it is complete."""
        return self._core.message

    @property
    def limit(self) -> Optional[str]:
        """Code of the limit that stopped the run, such as ``"walls-meet"``; None if none did."""
        return self._core.limit or None

    @property
    def warnings(self) -> list[str]:
        """Warnings, a sentence each."""
        return list(self._core.warnings)

    @property
    def history(self) -> Table:
        """Curves: a row at every output point, and rows just before and just after every event."""
        return self._history

    @property
    def events(self) -> Table:
        """Events: a row for each, with its name (column ``event``), contact class, and the state of the history."""
        return self._events

    @property
    def columns(self) -> list[str]:
        """Names of the history's columns."""
        return self._history.columns

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column of the history."""
        return self._history.units

    @property
    def info(self) -> dict[str, Any]:
        """Content of ``run.json``: status, contact classes, integrator, statistics, timings, versions, scenario."""
        content: dict[str, Any] = json.loads(self._core.json())
        return content

    def __len__(self) -> int:
        return len(self._history)

    def __contains__(self, column: object) -> bool:
        return column in self._history

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yields the rows of the history, as a :class:`monograin.Table` does."""
        return iter(self._history)

    def keys(self) -> list[str]:
        """Returns the names of the history's columns, so that ``dict(run)`` has them as arrays."""
        return self.columns

    _ipython_key_completions_ = keys

    @explained
    def __getitem__(self, column: str) -> NDArray[Any]:
        """Returns a column of the history, by its name (``"axial.force"``) or heading (``"axial.force[N]"``).

        Returns:
            Array of shape (rows,): numbers in the unit of the column, which is SI, or words.

        Raises:
            KeyError: for an unknown name; the message suggests the nearest column.
            TypeError: for anything but a str, such as the number of a row.
        """
        return self._history[column]

    def to_pandas(self) -> DataFrame:
        """Returns a copy of the history as a ``pandas.DataFrame``.

        Raises:
            ImportError: if pandas is not installed.
        """
        return self._history.to_pandas()

    @explained
    def plot(
        self,
        columns: Union[str, Sequence[str], None] = None,
        *,
        x: Optional[str] = None,
        axes: Union[Axes, Sequence[Axes], None] = None,
        label: str = "",
    ) -> Figure:
        """Draws force, mean pressure, contact area and apparent radius over the displacement of the driven wall.

        Loading is solid, unloading dashed, reloading dotted. Events have the symbols of the program's figures. Those of
        a contact are on its curves, those of the particle on curves of the particle. One legend stands below all
        panels; in axes of a figure that ``plot`` has not made, it stands in the first of them. A packing is drawn over
        its packing fraction, a material point over its axial strain. Quantities are dimensionless if the header of the
        history has their scales.

        A notebook shows the figure that the last line of a cell returns. In a loop, hand it to ``display`` of IPython.
        Several runs come into one figure by its axes:

        >>> figure = run.plot("axial.force", label="Y = 50 MPa")
        >>> softer.plot("axial.force", label="Y = 30 MPa", axes=figure.axes)

        Args:
            columns: name of a column, or names with a panel for each, in SI units; None: the panels above.
            x: name of the column for the abscissa, in SI units; None: the one above, or the time.
            axes: axes of matplotlib, one for each panel, to draw into; None: those of a new figure.
            label: name of the run in the legend.

        Returns:
            The ``matplotlib.figure.Figure``. If it is new, pyplot does not manage it; save it with its method
            ``savefig``.

        Raises:
            ImportError: if matplotlib is not installed.
            KeyError: for an unknown column.
            ValueError: if there is no curve to draw, a column holds words, or there are fewer axes than panels.
        """
        from . import _figure

        return _figure.of_run(self, columns, x, axes, label)

    @explained
    def save(self, folder: Path) -> None:
        """Writes ``history.csv``, ``events.csv`` and ``run.json`` as ``monograin run -o`` does, all of them or none.

        Args:
            folder: folder for the files, made if it does not exist. Files of an earlier run are replaced; others stay.

        Raises:
            RuntimeError: if a file cannot be written, or the folder holds a file of the user with the name of a result.
            ValueError: for an empty name.
        """
        if not os.fspath(folder):
            raise ValueError("folder: expected a name, not an empty text")
        self._core.save(os.fspath(folder))

    @explained
    def profile(self, time: float) -> Table:
        """Returns pressure and surface under the contacts at one instant, and runs the scenario again up to it.

        Args:
            time: instant [s] within the run. At an event, the state just before it counts.

        Returns:
            Table with columns ``class``, ``radius`` [m], ``pressure`` [Pa], ``displacement`` [m] of the surface and
            ``relaxed_height`` [m] of the unloaded surface; a row for each point of each closed contact class.

        Raises:
            RuntimeError: if the model has no profile, the instant is not finite or negative, the run ends before it, or
                no contact is closed then; for a run of finite elements.
        """
        if self._is_of_elements():
            raise RuntimeError("finite elements have no profile; the run of the law may have one")
        return Table(self.scenario._core.profile(time))

    @explained
    def write_vtk(self, folder: Path) -> None:
        """Writes particle and walls for ParaView, as ``monograin plot --vtk`` does, all files or none.

        ParaView opens the file ``run.pvd``. The other files have particle and walls at up to 200 instants, evenly chosen.
        Lengths are in m, forces in N and pressures in Pa.

        Args:
            folder: folder for the files, made if it does not exist. Files of an earlier particle are replaced; others
                stay.

        Raises:
            ValueError: for a model without a particle between walls, such as ``packing``, and an empty name.
            RuntimeError: if a file cannot be written, or the folder holds another result, or a file of yours with the name
                of one to write.
        """
        if not os.fspath(folder):
            raise ValueError("folder: expected a name, not an empty text")
        _core.write_vtk(self.scenario._core, self.history._core, os.fspath(folder))

    def to_lammps(self) -> str:
        """Returns the input file of LAMMPS for the same test, as ``monograin export lammps`` writes it.

        The file has the line ``pair_coeff`` for the material, and repeats the test: a particle at rest, and a plane for
        each wall, which moves as in this run. It needs the package GRANULAR of LAMMPS.

        >>> pathlib.Path("in.hertz").write_text(run.to_lammps())

        Raises:
            ValueError: for a model, or an option of it, whose law LAMMPS does not have; the message says why.
        """
        return _core.lammps_input(self.scenario._core, self.history._core)

    @explained
    def force_table(self, contact_class: Optional[str] = None) -> Table:
        """Returns the force of one wall over its displacement, as ``monograin export table`` writes it.

        Args:
            contact_class: name of a contact class, such as ``"axial"``; None: the first one that moves.

        Returns:
            Table with columns ``branch``, the displacement [m] and the force [N] of the class. Branches are numbered from
            1; each ends where the displacement turns, so that it has one force for each displacement. Instants at which
            the wall rests are left out. :meth:`Table.to_csv` gives the text of the command's file.

        Raises:
            ValueError: for a model without walls, an unknown class, or one that does not move.
        """
        return Table(_core.force_table(self.scenario._core, self.history._core, contact_class))

    def _is_of_elements(self) -> bool:
        """Returns True if finite elements computed the run in the place of the scenario's law."""
        return self.history.header.get("model") == "continuum"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        ends = [(run.status, run.message, run.limit, run.warnings, _lines_of_content(run)) for run in (self, other)]
        if ends[0] != ends[1] or self.scenario != other.scenario:
            return False
        return self.history._has_columns_of(other.history) and self.events._has_columns_of(other.events)

    def __hash__(self) -> int:
        return hash((self.status, self.history))

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self._history._repr_html_()}"

    def __repr__(self) -> str:
        why = f" ({self.message})" if self.message else ""
        count = len(self.warnings)
        warned = f", {count} warning{'s' if count > 1 else ''}" if count > 0 else ""
        return f"<Run {self.status}{why}: {len(self)} rows, {len(self.events)} events{warned}>"


@dataclass(frozen=True)
class _Source:
    """What a scenario is made of. It is made when it is asked for."""

    text: str
    origin: str
    overrides: tuple[str, ...]
    files: Optional[dict[str, str]]

    @classmethod
    def of(cls, scenario: Scenario) -> _Source:
        # With the absolute path of the origin another process finds the files that the scenario names.
        return cls(scenario.text, scenario.origin, tuple(scenario.overrides), scenario.files)

    def __call__(self) -> Scenario:
        # A text in memory may keep files that replaced values no longer name.
        scenario = Scenario.__new__(Scenario)
        scenario._core = _parsed(self.text, self.origin, list(self.overrides), self.files)
        return scenario


def _parsed(text: str, origin: str, overrides: list[str], files: Optional[dict[str, str]]) -> _core.Scenario:
    return _core.Scenario.parse(text, origin, overrides, files).with_origin(os.path.abspath(origin))


def _lines_of_content(run: Run) -> list[dict[str, str]]:
    """Returns the header lines of a run's tables, without those that comments or the name of the scenario change."""
    headers = (run.history.header, run.events.header)
    return [{key: line for key, line in header.items() if not key.startswith("scenario")} for header in headers]


def _made(source: _Source) -> Scenario:
    return source()


def _of_parts(text: str, history: Table, events: Table, scenario: _Source) -> Run:
    return Run(_Record(text, history._core, events._core), scenario)


def checked(run: Run, check: bool) -> Run:
    if check and run.status == "failed":
        raise SolverError(run.message, run)
    return run


# A prepared scenario makes runs, and a scenario makes prepared ones.
from .prepared import Prepared  # noqa: E402

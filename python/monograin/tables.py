"""Tables: histories, events, profiles, results of sweeps."""

from __future__ import annotations

import errno
import os
from typing import Any, Iterator, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core, _html
from ._inputs import Named, elements, explained, is_real, numbers, same, texts, unknown
from ._optional import DataFrame


class Table:
    """Rows of numbers and words under named columns.

    ``table["axial.force"]`` is a column. ``len(table)`` is the number of rows. Iteration yields the rows, each a dict
    from the name of a column to its value; ``in`` and ``keys`` are about columns. Columns of one name but different
    units, as a file may have them, are named with their units (``"force[N]"``).

    A column of numbers is a read-only view of the table's memory: nothing is copied, and the view stays valid after the
    table is deleted. Undefined values are nan. A column of words is a read-only array of str.

    Tables are equal if columns, units, header lines and all values are.
    """

    __slots__ = ("_core", "_words")

    def __init__(self, core: _core.Table) -> None:
        self._core = core
        self._words: dict[str, NDArray[np.str_]] = {}

    @classmethod
    @explained
    def read_csv(cls, file: Union[str, os.PathLike[str]]) -> Table:
        """Reads a CSV file, such as the ``history.csv`` of a run. An empty cell among numbers is nan.

        Numbers stay in the units of their headings, which are SI in files of the program.

        Raises:
            FileNotFoundError: if there is no such file.
            RuntimeError: if the file is not a table; the message has the position of the fault.
        """
        return cls(_core.read_csv(_existing(file)))

    @classmethod
    @explained
    def read_hdf5(cls, file: Union[str, os.PathLike[str]]) -> Table:
        """Reads an HDF5 file of the program, such as the ``results.h5`` of a sweep. Units are SI.

        Raises:
            FileNotFoundError: if there is no such file.
            RuntimeError: if the file is no such table, or HDF5 cannot be used; the message says why.
        """
        return cls(_core.read_hdf5(_existing(file)))

    @classmethod
    def from_columns(
        cls, columns: Union[Mapping[str, Any], DataFrame], units: Optional[Mapping[str, str]] = None
    ) -> Table:
        """Makes a table of arrays, such as measured curves.

        Args:
            columns: arrays of shape (rows,) by name, as a dict or a ``pandas.DataFrame``. A name may have its unit behind
                it (``"force[N]"``). Arrays of texts without a number become columns of words; the text ``"nan"`` among
                numbers is nan. Elements that are masked, None or ``pandas.NA`` are nan, and among words empty.
            units: units by the name of a column; if None, those that :meth:`to_pandas` gives a DataFrame.

        Raises:
            ValueError: for no arrays, arrays of different lengths, two columns of one name and unit, a unit of a column
                that there is not, a unit other than that in the heading, or a column that holds numbers and words.
            TypeError: for columns that are no mapping, units that are no texts by name, or an array of neither numbers nor
                texts.
        """
        if not hasattr(columns, "keys"):
            raise TypeError(f"columns: expected arrays by name, in a dict or a DataFrame, not {type(columns).__name__}")
        known = getattr(columns, "attrs", {}).get("units", {}) if units is None else texts(units, "units")
        parts: list[_core.ColumnParts] = []
        for heading in columns.keys():
            name, bracket, unit = str(heading).removesuffix("]").partition("[")
            if not bracket or not str(heading).endswith("]"):
                name, unit = str(heading), known.get(heading, "")
            elif known.get(heading, unit) != unit:
                raise ValueError(f"units: {known[heading]!r} for {heading!r}, whose heading has {unit!r}; expected one")
            if any(part[:2] == (name, unit) for part in parts):
                raise ValueError(f"there are two columns {name!r} of one unit; expected one")
            parts.append((name, unit, *_column(columns[heading], str(heading))))
        for name in known if units is not None else ():
            if name not in columns.keys():
                raise ValueError(f"units: {unknown(name, map(str, columns.keys()))}")
        shapes = [values.shape for *_, values in parts]
        if not parts or any(shape != shapes[0] or len(shape) != 1 for shape in shapes):
            raise ValueError(f"columns of shapes {shapes}; expected columns of equal length")
        return _of_columns([], parts)

    @property
    def columns(self) -> list[str]:
        """Names of the columns, without units, in their order."""
        return self._core.columns

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column by its name: ``"-"`` for a pure number, empty for words and counters.

        Units of the program's own tables are SI.
        """
        return Named(self._core.units)

    @property
    def header(self) -> dict[str, str]:
        """Header lines ``key: value`` of the table, such as program, scenario, model and material."""
        return Named(self._core.header)

    def __len__(self) -> int:
        return self._core.row_count

    def __contains__(self, column: object) -> bool:
        return isinstance(column, str) and self._core.contains(column)

    @explained
    def __getitem__(self, column: str) -> NDArray[Any]:
        """Returns a column, by its name (``"axial.force"``) or heading (``"axial.force[N]"``).

        Returns:
            Array of shape (rows,): numbers in the unit of the column, or words.

        Raises:
            KeyError: for an unknown name; the message suggests the nearest column.
            TypeError: for anything but a str, such as the number of a row.
        """
        if column not in self._words:
            if isinstance(column, str) and column not in self:
                raise KeyError(unknown(column, self.columns))
            values = self._core.values(column)
            labels = self._core.labels(column)
            if not labels:
                return values
            words = np.asarray(labels, dtype=str)[values.astype(np.intp)]
            words.flags.writeable = False
            self._words[column] = words
        return self._words[column]

    def keys(self) -> list[str]:
        """Returns the names of the columns, so that ``dict(table)`` has them as arrays."""
        return self.columns

    _ipython_key_completions_ = keys

    def __reduce__(self) -> tuple[Any, ...]:
        return (_of_columns, (self._core.header, self._core.parts()))

    def __iter__(self) -> Iterator[dict[str, Any]]:
        names = self.columns
        # Pieces of the columns become lists, so that the first rows of a long table come at once.
        for begin in range(0, len(self), 1024):
            values = [self._cells(name, slice(begin, begin + 1024)).tolist() for name in names]
            yield from (dict(zip(names, row)) for row in zip(*values))

    def _cells(self, name: str, rows: slice = slice(None)) -> NDArray[Any]:
        """Returns a copy of some rows of a column. Rows share the texts of their words."""
        labels, values = self._core.labels(name), self._core.values(name)[rows]
        return np.asarray(labels, dtype=object)[values.astype(np.intp)] if labels else values.copy()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        return self._core.header == other._core.header and self._has_columns_of(other)

    def _has_columns_of(self, other: Table) -> bool:
        """Returns True if two tables are equal but for their header lines."""
        if (self.columns, self.units) != (other.columns, other.units):
            return False
        return all(same(self[name], other[name]) for name in self.columns)

    def __hash__(self) -> int:
        return hash((len(self), *self.columns))

    def to_pandas(self) -> DataFrame:
        """Returns a copy as a ``pandas.DataFrame`` with the same columns; its ``attrs["units"]`` are :attr:`units`.

        Raises:
            ImportError: if pandas is not installed.
        """
        import pandas

        frame = pandas.DataFrame({name: self._cells(name) for name in self.columns})
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_csv(self) -> str:
        """Returns the table as CSV text, as files of the program have it: header lines, a heading with its unit for each
        column, and a line for each row. :meth:`read_csv` reads it; numbers stay the same bit by bit.

        >>> pathlib.Path("force.csv").write_text(run.force_table().to_csv())
        """
        return self._core.csv()

    def _repr_html_(self) -> str:
        count = f"{len(self)} row{'' if len(self) == 1 else 's'}"
        names = list(self.units)
        headings = [f"{name} [{unit}]" if unit and not name.endswith("]") else name for name, unit in self.units.items()]
        return _html.excerpt(f"Table of {count}", headings, lambda k: self[names[k]], len(self))

    def __repr__(self) -> str:
        return f"<Table of {len(self)} rows: {', '.join(self.columns)}>"


def _existing(file: Union[str, os.PathLike[str]]) -> str:
    """Returns the name of a file. Raises FileNotFoundError if there is none."""
    name = os.fspath(file)
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    return name


def _of_columns(header: list[tuple[str, str]], columns: list[_core.ColumnParts]) -> Table:
    return Table(_core.table_of(header, columns))


def _column(values: Any, name: str) -> tuple[list[str], NDArray[np.float64]]:
    """Returns the labels of a column, empty for numbers, and its values."""
    label = f"column {name!r}"
    array, is_missing = elements(values, label)
    present = array[~is_missing].tolist() if array.dtype.kind in "OSU" else []
    cells = [cell.decode() if isinstance(cell, bytes) else cell for cell in present]
    if array.dtype.kind not in "SU" and not any(isinstance(cell, str) for cell in cells):
        return [], numbers(values, label)
    readings = [_reading(cell) for cell in cells]
    has_number = any(reading is not None and not np.isnan(reading) for reading in readings)
    for cell, reading in zip(cells, readings):
        if reading is None and (has_number or not isinstance(cell, str)):
            found = "numbers" if has_number else "texts"
            raise ValueError(f"{label} holds {found} and {cell!r}; expected numbers or words")
    if cells and None not in readings:
        result: NDArray[np.float64] = np.full(array.shape, np.nan)
        result[~is_missing] = readings
        return [], result
    words = np.full(array.shape, "", dtype=object)
    words[~is_missing] = [cell if isinstance(cell, str) else "" for cell in cells]
    labels, codes = np.unique(words.astype(str), return_inverse=True)
    # A label that no row has keeps a column without rows one of words.
    return labels.tolist() or [""], codes.reshape(array.shape).astype(float)


def _reading(cell: Any) -> Optional[float]:
    """Returns the number that a cell or its text is, None if it is none. The text ``"nan"`` is the number nan."""
    try:
        return float(cell) if isinstance(cell, str) or is_real(cell) else None
    except ValueError:
        return None

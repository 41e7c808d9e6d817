"""Tables: histories, events, profiles, results of sweeps."""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core

if TYPE_CHECKING:
    import pandas


class Table:
    """Rows of numbers and words under named columns.

    ``table["axial.force"]`` is a column. ``len(table)`` is the number of rows. Iteration yields the rows, each a dict
    from the name of a column to its value; ``in`` and ``keys`` are about columns. Columns of one name but different
    units, as a file may have them, are named with their units (``"force[N]"``).

    A column of numbers is a read-only view of the table's memory: nothing is copied, and the view stays valid after the
    table is deleted. Undefined values are nan. A column of words is a read-only array of str.
    """

    def __init__(self, core: _core.Table) -> None:
        self._core = core
        self._words: dict[str, NDArray[np.str_]] = {}

    @classmethod
    def read_csv(cls, file: Union[str, os.PathLike[str]]) -> Table:
        """Reads a CSV file, such as the ``history.csv`` of a run. An empty cell among numbers is nan.

        Numbers stay in the units of their headings, which are SI in files of the program.

        Raises:
            FileNotFoundError: if there is no such file.
            RuntimeError: if the file is not a table; the message has the position of the fault.
        """
        name = os.fspath(file)
        if not os.path.exists(name):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
        return cls(_core.read_csv(name))

    @classmethod
    def from_columns(
        cls, columns: Union[Mapping[str, Any], pandas.DataFrame], units: Optional[Mapping[str, str]] = None
    ) -> Table:
        """Makes a table of arrays, such as measured curves.

        Args:
            columns: arrays of shape (rows,) by name, as a dict or a ``pandas.DataFrame``. A name may have its unit behind
                it (``"force[N]"``). Arrays without a number become columns of words.
            units: units by the name of a column; if None, those that :meth:`to_pandas` gives a DataFrame.

        Raises:
            ValueError: for no arrays, or arrays of different lengths.
        """
        known: Mapping[str, str] = getattr(columns, "attrs", {}).get("units", {}) if units is None else units
        parts: list[_core.ColumnParts] = []
        for heading in columns:
            name, bracket, unit = str(heading).removesuffix("]").partition("[")
            if not bracket or not str(heading).endswith("]"):
                name, unit = str(heading), known.get(heading, "")
            values = np.asarray(columns[heading])
            labels: list[str] = []
            if values.dtype.kind in "OUS" and not any(map(_is_number, values.ravel().tolist())):
                words, values = np.unique(values.astype(str), return_inverse=True)
                labels = words.tolist()
            parts.append((name, unit, labels, values.astype(float)))
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
        return self._core.units

    @property
    def header(self) -> dict[str, str]:
        """Header lines ``key: value`` of the table, such as program, scenario, model and material."""
        return dict(self._core.header)

    def __len__(self) -> int:
        return self._core.row_count

    def __contains__(self, column: object) -> bool:
        return isinstance(column, str) and self._core.contains(column)

    def __getitem__(self, column: str) -> NDArray[Any]:
        """Returns a column, by its name (``"axial.force"``) or heading (``"axial.force[N]"``).

        Returns:
            Array of shape (rows,): numbers in the unit of the column, or words.

        Raises:
            KeyError: for an unknown name; the message suggests the nearest column.
        """
        if column not in self._words:
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
        values = [self[name].tolist() for name in names]
        return (dict(zip(names, row)) for row in zip(*values))

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a copy as a ``pandas.DataFrame`` with the same columns; its ``attrs["units"]`` are :attr:`units`.

        Raises:
            ImportError: if pandas is not installed.
        """
        import pandas

        frame = pandas.DataFrame({name: self[name].copy() for name in self.columns})
        frame.attrs["units"] = self.units
        return frame

    def __repr__(self) -> str:
        return f"<Table of {len(self)} rows: {', '.join(self.columns)}>"


def _of_columns(header: list[tuple[str, str]], columns: list[_core.ColumnParts]) -> Table:
    return Table(_core.table_of(header, columns))


def _is_number(value: Any) -> bool:
    try:
        return not np.isnan(float(value))
    except (TypeError, ValueError):
        return False

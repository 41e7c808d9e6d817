"""Short tables for notebooks."""

from __future__ import annotations

import html
from typing import Any, Callable, Iterable

# A longer table shows this many of its first rows and of its last rows, and this many of its first columns.
_ROWS = 5
_COLUMNS = 12


def table(caption: str, headings: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Returns a table as HTML. Texts stand as they are; numbers have five digits."""
    head = "".join(f"<th>{html.escape(heading)}</th>" for heading in headings)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(_text(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<p>{html.escape(caption)}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def excerpt(caption: str, headings: list[str], column: Callable[[int], Any], count: int) -> str:
    """Returns the first columns of a table, and of these the first and the last rows, as HTML.

    Args:
        caption: text above the table.
        headings: of all columns.
        column: column by its number, an array; called for those that are shown.
        count: number of rows.
    """
    names = headings[:_COLUMNS]
    left_out = len(headings) - len(names)
    columns = [column(k) for k in range(len(names))]
    places = [*range(count)] if count <= 2 * _ROWS else [*range(_ROWS), None, *range(count - _ROWS, count)]
    rows = [["..." if row is None else cells[row] for cells in columns] for row in places]
    more = f"; {left_out} more columns" if left_out else ""
    return table(caption + more, names, rows)


def _text(cell: Any) -> str:
    return cell if isinstance(cell, str) else f"{cell:.5g}"

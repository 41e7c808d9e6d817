"""Short tables for notebooks."""

from __future__ import annotations

import html
from typing import Any, Iterable

# A longer table shows this many of its first rows and of its last rows, and this many of its first columns.
_ROWS = 5
_COLUMNS = 12


def table(caption: str, headings: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Returns a table as HTML. Texts stand as they are; numbers have five digits."""
    head = "".join(f"<th>{html.escape(heading)}</th>" for heading in headings)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(_text(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<p>{html.escape(caption)}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def excerpt(caption: str, columns: dict[str, Any]) -> str:
    """Returns the first columns of a table, and of these the first and the last rows, as HTML.

    Args:
        caption: text above the table.
        columns: arrays of equal length by heading.
    """
    names = list(columns)[:_COLUMNS]
    left_out = len(columns) - len(names)
    count = len(columns[names[0]]) if names else 0
    places = [*range(count)] if count <= 2 * _ROWS else [*range(_ROWS), None, *range(count - _ROWS, count)]
    rows = [["..." if row is None else columns[name][row] for name in names] for row in places]
    more = f"; {left_out} more columns" if left_out else ""
    return table(caption + more, names, rows)


def _text(cell: Any) -> str:
    return cell if isinstance(cell, str) else f"{cell:.5g}"

"""Writes values as TOML 1.0 text."""

from __future__ import annotations

import math
import os
import re
from typing import Any, Iterator, Mapping

import numpy as np

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_NEEDS_ESCAPE = re.compile(r'[\x00-\x1f"\\\x7f]')


def text_of(value: Any, key: str = "value") -> str:
    """Returns a value as TOML text that can follow ``key =``; mappings become inline tables.

    Args:
        value: str, float, int, bool, a list or tuple of values, a mapping from str to values, a path, or a scalar or
            array of numpy.
        key: name of the value in messages.

    Raises:
        ValueError: for nan and infinities, integers beyond 64 bits, and text that is not Unicode.
        TypeError: for other types.
    """
    plain = _plain(value)
    if isinstance(plain, bool):
        return "true" if plain else "false"
    if isinstance(plain, int):
        if not -(2**63) <= plain < 2**63:
            raise ValueError(f"{key}: {plain} is beyond the integers of TOML; write it as a float")
        return str(plain)
    if isinstance(plain, float):
        if not math.isfinite(plain):
            raise ValueError(f"{key}: {plain} is not a finite number")
        return float.__repr__(plain)
    if isinstance(plain, str):
        return _quoted(plain, key)
    if isinstance(plain, Mapping):
        return "{" + ", ".join(f"{_key(k, key)} = {text_of(v, f'{key}.{k}')}" for k, v in plain.items()) + "}"
    if isinstance(plain, (list, tuple)):
        return "[" + ", ".join(text_of(item, f"{key}[{i}]") for i, item in enumerate(plain)) + "]"
    raise TypeError(f"{key}: a {type(value).__name__} cannot be written; expected str, float, int, bool, list or dict")


def document(tables: Mapping[str, Any]) -> str:
    """Returns a mapping as a TOML document: mappings become tables, lists of mappings arrays of tables.

    Raises:
        ValueError, TypeError: as :func:`text_of`.
    """
    return "\n".join(_lines(tables, ())) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(item, Mapping) for item in value)


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    where = ".".join(path)
    # Values come before tables: a key after the heading of a table would belong to that table.
    for key, value in table.items():
        if not isinstance(value, Mapping) and not _is_tables(value):
            yield f"{_key(key, where)} = {text_of(value, '.'.join((*path, key)))}"
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield f"\n[{_heading((*path, key))}]"
            yield from _lines(value, (*path, key))
        elif _is_tables(value):
            for item in value:
                yield f"\n[[{_heading((*path, key))}]]"
                yield from _lines(item, (*path, key))


def _heading(path: tuple[str, ...]) -> str:
    return ".".join(_key(part, ".".join(path)) for part in path)


def _key(key: Any, where: str) -> str:
    if not isinstance(key, str):
        raise TypeError(f"{where}: the key {key!r} is not a str")
    return key if _BARE_KEY.fullmatch(key) else _quoted(key, where)


def _quoted(text: str, key: str) -> str:
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        raise ValueError(f"{key}: {text!r} is not Unicode text") from None
    return '"' + _NEEDS_ESCAPE.sub(lambda found: _escape(found.group()), text) + '"'


def _escape(character: str) -> str:
    return "\\" + character if character in '"\\' else f"\\u{ord(character):04X}"

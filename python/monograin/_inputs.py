"""Input of callers: names, arrays of numbers, and arguments of the right type."""

from __future__ import annotations

import collections.abc
import difflib
import functools
import inspect
import sys
import typing
from typing import Any, Callable, Iterable, Mapping, NoReturn, Optional, ParamSpec, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Value = TypeVar("Value")
Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


class Named(dict[str, Value]):
    """Values by name. An unknown name is a ``KeyError`` that suggests the nearest ones."""

    def __missing__(self, name: object) -> NoReturn:
        raise KeyError(unknown(name, self))


def unknown(name: object, names: Iterable[str]) -> str:
    """Returns a sentence about a name that is none of these, with the nearest ones."""
    known = list(names)
    text = str(name)
    near = difflib.get_close_matches(text, known) or [entry for entry in known if text in entry]
    if near:
        return f"there is no {name!r}; did you mean {', '.join(map(repr, near))}?"
    return f"there is no {name!r}; expected one of {', '.join(map(repr, known))}"


def elements(values: Any, name: str = "") -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """Returns values as a plain array, and True for each element that is masked, None or ``pandas.NA``.

    A single None or ``pandas.NA`` is a value like others. Texts in a list do not turn its other elements into texts.

    Args:
        values: a number, an array, or what numpy makes an array of.
        name: name of the values, with which messages begin.

    Raises:
        TypeError: for sequences of unequal lengths.
    """
    masked: Any = np.ma
    if hasattr(values, "isna") and hasattr(values, "to_numpy"):
        return np.asarray(values.to_numpy()), np.asarray(values.isna())
    try:
        array = np.asarray(masked.getdata(values))
        if array.dtype.kind in "SU" and not hasattr(values, "dtype"):
            array = np.asarray(values, dtype=object)
    except ValueError:
        raise TypeError(f"{_prefix(name)}expected numbers, not sequences of unequal lengths") from None
    is_missing: NDArray[np.bool_] = np.array(masked.getmaskarray(values), dtype=bool)
    if array.dtype.kind == "O" and array.ndim > 0:
        absent = (None, getattr(sys.modules.get("pandas"), "NA", None))
        cells = (any(cell is entry for entry in absent) for cell in array.ravel().tolist())
        is_missing = is_missing | np.fromiter(cells, bool, array.size).reshape(array.shape)
    return array, is_missing


def numbers(values: Any, name: str = "") -> NDArray[np.float64]:
    """Returns numbers as an array of float. Elements that are masked, None or ``pandas.NA`` are nan.

    Args:
        values: a number, an array, or what numpy makes an array of.
        name: name of the values, with which messages begin.

    Raises:
        TypeError: for texts, dates, complex numbers, a single None or ``pandas.NA``, and other things that are no real
            numbers, and for sequences of unequal lengths.
    """
    array, is_missing = elements(values, name)
    if array.dtype.kind in "SUMmcV":
        raise TypeError(f"{_prefix(name)}expected real numbers, not {_kind(array) if array.ndim else shown(values)}")
    if array.dtype.kind == "O":
        for value in array[~is_missing]:
            if not is_real(value):
                raise TypeError(f"{_prefix(name)}expected real numbers, not {value!r}")
    result: NDArray[np.float64] = np.full(array.shape, np.nan)
    result[~is_missing] = array[~is_missing]
    return result


def texts(values: Any, name: str) -> dict[str, str]:
    """Returns texts by name as a dict.

    Raises:
        TypeError: for anything but a mapping from str to str.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"{name}: expected texts by name, in a dict, not {shown(values)}")
    for key, value in values.items():
        if not isinstance(key, str) or not isinstance(value, str):
            raise TypeError(f"{name}: expected texts by name, not {shown(value)} by {shown(key)}")
    return dict(values)


def is_real(value: Any) -> bool:
    """Returns True for a single real number, of Python, numpy or another package. A text is none."""
    dtype = getattr(value, "dtype", None)
    if isinstance(dtype, np.dtype):
        return np.ndim(value) == 0 and dtype.kind in "fiub"
    return hasattr(value, "__float__") or hasattr(value, "__index__")


def same(a: Any, b: Any) -> bool:
    """Returns True if arrays, numbers, or tuples and dicts of these are equal. A nan is equal to a nan.

    Arrays without elements are equal if their shapes are: a file does not tell whether they would hold words.
    """
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(same, a, b))
    ours, theirs = np.asarray(a), np.asarray(b)
    if ours.size == theirs.size == 0:
        return ours.shape == theirs.shape
    return np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == theirs.dtype.kind == "f")


def explained(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Makes a function that fails for an argument of a wrong type raise a ``TypeError`` that names this argument.

    Annotations say which types are right. A call that succeeds costs nothing more.
    """

    @functools.wraps(function)
    def call(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Result:
        try:
            return function(*args, **kwargs)
        except (AttributeError, IndexError, TypeError) as error:
            problem = _problem(function, args, kwargs)
            is_explained = str(error).startswith(problem.partition(" ")[0])
            if not problem or is_explained:
                raise
        raise TypeError(problem)

    return call


def _problem(function: Callable[..., Any], args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> str:
    """Returns a sentence about the first argument of a wrong type; empty if there is none."""
    try:
        arguments = inspect.signature(function).bind(*args, **kwargs).arguments
    except TypeError:
        return ""
    hints = typing.get_type_hints(function)
    for name, value in arguments.items():
        hint = hints.get(name, Any)
        others = _beside_arrays(hint)
        if others is not None and not any(_fits(value, other) for other in others):
            try:
                numbers(value, name)
            except TypeError as error:
                return str(error)
        elif others is None and not _fits(value, hint):
            return f"{name}: expected {_words(hint)}, not {shown(value)}"
    return ""


def _beside_arrays(hint: Any) -> Optional[list[Any]]:
    """Returns the types that an annotation admits beside ArrayLike, which is a union itself; None without ArrayLike."""
    parts, arrays = typing.get_args(hint), set(typing.get_args(ArrayLike))
    if typing.get_origin(hint) is not Union or not arrays <= set(parts):
        return None
    return [part for part in parts if part not in arrays]


def _fits(value: Any, hint: Any) -> bool:
    """Returns False if a value has not the type of an annotation; True if that is not known."""
    origin, parts = typing.get_origin(hint) or hint, typing.get_args(hint)
    if hint is Any:
        return True
    if origin is Union:
        return any(_fits(value, part) for part in parts)
    if origin is float:
        return is_real(value)
    if origin is int:
        return hasattr(value, "__index__") and is_real(value)
    if not inspect.isclass(origin):
        return True
    if origin is collections.abc.Sequence and hasattr(value, "__array__"):
        return True
    if not isinstance(value, origin):
        return False
    if isinstance(value, Mapping) and len(parts) == 2 and _beside_arrays(parts[1]) is None:
        return all(_fits(key, parts[0]) and _fits(entry, parts[1]) for key, entry in value.items())
    if isinstance(value, (list, tuple)) and parts:
        kinds = parts if origin is tuple else parts * len(value)
        return len(kinds) == len(value) and all(map(_fits, value, kinds))
    return True


def _words(hint: Any) -> str:
    if typing.get_origin(hint) is Union:
        return " or ".join(map(_words, typing.get_args(hint)))
    if hint is type(None):
        return "None"
    parts = ", ".join(map(_words, typing.get_args(hint)))
    name = str(getattr(typing.get_origin(hint) or hint, "__name__", hint))
    return f"{name}[{parts}]" if parts else name


def shown(value: Any) -> str:
    """Returns a value as messages show it; a long one by its type."""
    text = repr(value)
    return text if len(text) <= 40 and "\n" not in text else f"a {type(value).__name__}"


def _prefix(name: str) -> str:
    return f"{name}: " if name else ""


def _kind(array: NDArray[Any]) -> str:
    return {"M": "dates", "m": "times", "c": "complex numbers", "V": "records"}.get(array.dtype.kind, "texts")

"""What callers hand in: names, arrays of numbers, and arguments of the right type."""

from __future__ import annotations

import difflib
import functools
import inspect
import typing
from typing import Any, Callable, Iterable, Mapping, NoReturn, ParamSpec, TypeVar, Union

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


def numbers(values: Any, name: str = "") -> NDArray[np.float64]:
    """Returns numbers as an array of float. Elements that are masked, or missing as in pandas, are nan.

    Args:
        values: a number, an array, or what numpy makes an array of.
        name: name of the values, with which messages begin.

    Raises:
        TypeError: for texts, dates, complex numbers, None, and other things that are no real numbers, and for sequences
            of unequal lengths.
    """
    masked: Any = np.ma
    prefix = f"{name}: " if name else ""
    is_pandas = hasattr(values, "isna") and hasattr(values, "to_numpy")
    try:
        array = values.to_numpy() if is_pandas else masked.getdata(values)
    except ValueError:
        raise TypeError(f"{prefix}expected numbers, not sequences of unequal lengths") from None
    missing = np.asarray(values.isna()) if is_pandas else masked.getmaskarray(values)
    if array.dtype.kind in "SUMmcV":
        raise TypeError(f"{prefix}expected real numbers, not {_kind(array) if array.ndim else _shown(values)}")
    if array.dtype.kind == "O":
        if array.ndim > 0:
            missing = missing | np.equal(array, np.array(None))
        for value in array[~missing]:
            if not _is_number(value):
                raise TypeError(f"{prefix}expected real numbers, not {value!r}")
    result: NDArray[np.float64] = np.full(array.shape, np.nan)
    result[~missing] = array[~missing]
    return result


def same(a: Any, b: Any) -> bool:
    """Returns True if arrays, numbers, or tuples and dicts of these are equal. A nan is equal to a nan."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(same, a, b))
    ours, theirs = np.asarray(a), np.asarray(b)
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
        if hint == ArrayLike:
            try:
                numbers(value, name)
            except TypeError as error:
                return str(error)
        elif not _fits(value, hint):
            return f"{name}: expected {_words(hint)}, not {_shown(value)}"
    return ""


def _fits(value: Any, hint: Any) -> bool:
    """Returns False if a value has not the type of an annotation; True if that is not known."""
    origin, parts = typing.get_origin(hint) or hint, typing.get_args(hint)
    if hint is Any:
        return True
    if origin is Union:
        return any(_fits(value, part) for part in parts)
    if origin is float:
        return _is_number(value)
    if origin is int:
        return hasattr(value, "__index__")
    if not inspect.isclass(origin):
        return True
    if not isinstance(value, origin):
        return False
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


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 and "\n" not in text else f"a {type(value).__name__}"


def _is_number(value: Any) -> bool:
    return hasattr(value, "__float__") or hasattr(value, "__index__")


def _kind(array: NDArray[Any]) -> str:
    return {"M": "dates", "m": "times", "c": "complex numbers", "V": "records"}.get(array.dtype.kind, "texts")

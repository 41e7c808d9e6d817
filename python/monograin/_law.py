"""The parts that all laws share: evaluation over arrays that broadcast, and the argument ``out``."""

from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, Optional, ParamSpec, Union, cast

import numpy as np
from numpy.typing import NDArray

from ._core import Elementwise
from ._inputs import explained

__all__ = ["Elementwise", "law"]

Parameters = ParamSpec("Parameters")
Result = Union[float, NDArray[np.float64]]
Output = Optional[NDArray[np.float64]]

_OUT = """
    out: writable array of float64 with the shape of the result, and without a mask; it receives the result, and is
        returned. None: a new array. An error, or Ctrl-C, may leave it partly written.
"""


def law(function: Callable[Parameters, Elementwise]) -> Callable[Parameters, Result]:
    """Makes a law of a function that returns its evaluation: adds the argument ``out``, and evaluates into it.

    Type checkers read the stubs of the wheel instead, which state for every law that numbers give a float and arrays an
    array (python/backend/law_stubs.py).
    """

    def evaluated(*args: Any, out: Output = None, **kwargs: Any) -> Result:
        return function(*args, **kwargs).into(out)

    functools.update_wrapper(evaluated, function)
    signature = inspect.signature(function)
    output = inspect.Parameter("out", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Output)
    signature = signature.replace(parameters=[*signature.parameters.values(), output], return_annotation=Result)
    evaluated.__signature__ = signature  # type: ignore[attr-defined]
    evaluated.__annotations__ = {**function.__annotations__, "out": Output, "return": Result}
    arguments, raises, errors = (inspect.getdoc(function) or "").partition("\n\nRaises:\n")
    evaluated.__doc__ = arguments + _OUT.rstrip() + raises + errors
    return explained(cast(Callable[Parameters, Result], evaluated))

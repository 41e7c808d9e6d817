"""Makes the stubs of the laws from their sources.

A law takes numbers or arrays for each argument. Python's annotations cannot derive the type of its result from those of
its arguments, so a stub states two signatures for each law: numbers give a float, and arrays an array.
"""

from __future__ import annotations

import ast
import copy
import pathlib
from typing import Iterator

HEADING = """from typing import Any, NamedTuple, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Number = Union[float, np.floating[Any], np.integer[Any], np.bool_]
"""


def law_stubs(folder: pathlib.Path) -> Iterator[tuple[str, str]]:
    """Yields the name and the text of the stub of each module of laws in a folder."""
    for source in sorted(folder.glob("[!_]*.py")):
        yield source.with_suffix(".pyi").name, stub(source.read_text())


def stub(source: str) -> str:
    """Returns the text of the stub of a module of laws."""
    parts = [part for node in ast.parse(source).body for part in _stated(node)]
    return "\n".join([HEADING, *map(ast.unparse, parts), ""])


def _stated(node: ast.stmt) -> list[ast.stmt]:
    """Returns what a stub states of a part of a module."""
    if isinstance(node, ast.ClassDef):
        return [_class(node)]
    if isinstance(node, ast.FunctionDef):
        return _signatures(node) if _is_law(node) else [_declared(node)]
    return [node] if isinstance(node, (ast.Assign, ast.Import)) else []


def _is_law(node: ast.FunctionDef) -> bool:
    return any(isinstance(decorator, ast.Name) and decorator.id == "law" for decorator in node.decorator_list)


def _signatures(node: ast.FunctionDef) -> list[ast.stmt]:
    """Returns the two signatures of a law."""
    numbers, arrays = _declared(node), _declared(node)
    for argument in (*numbers.args.args, *numbers.args.kwonlyargs):
        if _text(argument.annotation) == "ArrayLike":
            argument.annotation = _type("_Number")
    numbers.returns, arrays.returns = _type("float"), _type("NDArray[np.float64]")
    for signature, output in ((numbers, "None"), (arrays, "Optional[NDArray[np.float64]]")):
        signature.args.kwonlyargs.append(ast.arg("out", _type(output)))
        signature.args.kw_defaults.append(ast.Constant(None))
        signature.decorator_list = [ast.Name("overload")]
    # ArrayLike includes numbers, so that both signatures take them; the first one counts then.
    numbers.type_comment = "ignore[misc]"
    return [numbers, arrays]


def _declared(node: ast.FunctionDef) -> ast.FunctionDef:
    """Returns a function without its decorators and its body."""
    declared = copy.deepcopy(node)
    declared.decorator_list = []
    declared.body = [ast.Expr(ast.Constant(...))]
    return declared


def _class(node: ast.ClassDef) -> ast.ClassDef:
    """Returns a class without the bodies of its methods and without docstrings."""
    declared = copy.deepcopy(node)
    members = [_declared(entry) if isinstance(entry, ast.FunctionDef) else entry for entry in declared.body]
    declared.body = [entry for entry in members if not isinstance(entry, ast.Expr)]
    return declared


def _type(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _text(annotation: ast.expr | None) -> str:
    return "" if annotation is None else ast.unparse(annotation)

"""Models, the scenario language, and ready scenarios."""

from __future__ import annotations

import json
import pathlib
from dataclasses import dataclass
from typing import Any, NamedTuple, Union

from . import _core
from .runs import Scenario


@dataclass(frozen=True)
class Key:
    """A key that a model reads.

    Attributes:
        name: as in a scenario file.
        meaning: a phrase.
        kind: ``"quantity"``, ``"choice"``, ``"toggle"`` or ``"file"``.
        unit: of a quantity in SI; ``"-"`` of a pure number; empty for other kinds.
        lower, upper: bounds of a quantity.
        lower_is_open, upper_is_open: whether a bound itself is out.
        default: value where the key is absent; None if there is none.
        choices: words of a choice.
        is_required: whether the key must be given.
    """

    name: str
    meaning: str
    kind: str
    unit: str
    lower: float
    upper: float
    lower_is_open: bool
    upper_is_open: bool
    default: Union[float, str, bool, None]
    choices: tuple[str, ...]
    is_required: bool


@dataclass(frozen=True)
class Model:
    """A contact law, or a law of a body without walls.

    Attributes:
        name, summary: what it is.
        references: publications that it is taken from, the main one first; a line each, with DOI.
        source: where in them the law stands, and which misprints are corrected; may be empty.
        material: keys of ``[material]``, by name.
        options: keys of the table that bears the model's name.
        steps: quantities that steps prescribe of a model without walls.
        presets: materials that ``preset`` in ``[material]`` may name, with their source.
        configurations: wall sets; empty where the model has no walls.
        has_walls, has_free_centre, has_profile: what the model knows.
        regimes, events: names with a sentence each.
        validity: limits of the model, a sentence each.
    """

    name: str
    summary: str
    references: list[str]
    source: str
    material: dict[str, Key]
    options: dict[str, Key]
    steps: dict[str, Key]
    presets: dict[str, str]
    configurations: list[str]
    has_walls: bool
    has_free_centre: bool
    has_profile: bool
    regimes: dict[str, str]
    events: dict[str, str]
    validity: list[str]


def models() -> dict[str, Model]:
    """Returns all models by name, in the order of ``monograin models``."""
    return {entry["name"]: _model(entry) for entry in _core.models()}


def _model(entry: dict[str, Any]) -> Model:
    fields = dict(entry)
    for table in ("material", "options", "steps"):
        fields[table] = {key["name"]: Key(**key) for key in entry[table]}
    fields["presets"] = dict(entry["presets"])
    return Model(**fields)


class Parameter(NamedTuple):
    """A constant that follows from a scenario before anything moves.

    Attributes:
        value: in ``unit``.
        unit: SI; ``"-"`` of a pure number.
        symbol: in the source; empty if it has none.
    """

    value: float
    unit: str
    symbol: str


def parameters(scenario: Scenario) -> dict[str, Parameter]:
    """Returns the derived constants of a scenario's material and particle, by name.

    They are those that ``monograin models --parameters FILE`` prints.
    """
    return {name: Parameter(value, unit, symbol) for name, value, unit, symbol in scenario._core.parameters()}


def schema() -> dict[str, Any]:
    """Returns the JSON Schema (draft 7) of scenario files, for editors and validators."""
    content: dict[str, Any] = json.loads(_core.schema())
    return content


def scenario_folder() -> pathlib.Path:
    """Returns the folder of the ready scenarios; ``sweeps``, ``calibrate`` and ``design`` in it hold files for them."""
    return pathlib.Path(__file__).parent / "scenarios"


def scenarios() -> list[str]:
    """Returns the names of the ready scenarios."""
    return sorted(path.stem for path in scenario_folder().glob("*.toml"))


def scenario(name: str = "die") -> Scenario:
    """Returns a ready scenario.

    Args:
        name: one of :func:`scenarios`.

    Raises:
        KeyError: listing the names there are.
    """
    if name not in scenarios():
        raise KeyError(f"there is no ready scenario '{name}'; there are {', '.join(scenarios())}")
    return Scenario.load(scenario_folder() / f"{name}.toml")

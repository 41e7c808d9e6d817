"""Catalogue: models, the scenario language, ready scenarios."""

from __future__ import annotations

import json
import pathlib
from dataclasses import dataclass
from typing import Any, NamedTuple, Union

from . import _core
from ._inputs import Named, explained, unknown
from .runs import Scenario


@dataclass(frozen=True)
class Key:
    """A key that a model reads.

    Attributes:
        name: name of the key, as in a scenario file.
        meaning: the quantity or option that the key sets, as a phrase.
        kind: ``"quantity"``, ``"choice"``, ``"toggle"`` or ``"file"``.
        unit: SI unit of a quantity; ``"-"`` for a pure number; empty for other kinds.
        lower: lower bound of a quantity, in ``unit``.
        upper: upper bound of a quantity, in ``unit``.
        lower_is_open: True if the lower bound itself is not admissible.
        upper_is_open: True if the upper bound itself is not admissible.
        default: value that an absent key has; None if there is none.
        choices: admissible words of a choice.
        is_required: True if the key must be given.
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


@dataclass(frozen=True, repr=False)
class Model:
    """A contact law, or a law of a body without walls.

    Attributes:
        name: name of the model in scenario files.
        summary: the model in a phrase.
        references: publications of the law, the main one first; a line each, with DOI.
        source: equations of the publications that give the law, and misprints that are corrected; may be empty.
        material: keys of ``[material]``, by name.
        options: keys of the table named after the model, by name.
        steps: quantities that a step prescribes in a model without walls, by name.
        presets: materials that ``preset`` in ``[material]`` may name, with their source.
        configurations: wall sets that a scenario may name; empty if the model has no walls.
        has_walls: True if the model has a particle between walls.
        has_free_centre: True if ``[loading] centre = "equilibrium"`` is allowed.
        has_profile: True if :meth:`monograin.Run.profile` gives pressure and surface under a contact.
        regimes: names of the regimes, with a sentence about each.
        events: names of the events, with a sentence about each.
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

    def __repr__(self) -> str:
        return f"<Model {self.name!r}: {self.summary}>"


def models() -> dict[str, Model]:
    """Returns all models by name, in the order of ``monograin models``."""
    return Named({entry["name"]: _model(entry) for entry in _core.models()})


def _model(entry: dict[str, Any]) -> Model:
    fields = dict(entry)
    for table in ("material", "options", "steps"):
        fields[table] = Named({key["name"]: Key(**key) for key in entry[table]})
    for table in ("presets", "regimes", "events"):
        fields[table] = Named(entry[table])
    return Model(**fields)


class Parameter(NamedTuple):
    """A constant of a scenario: a material parameter, or a constant that follows from the material.

    Attributes:
        value: value in ``unit``.
        unit: SI unit; ``"-"`` for a pure number.
        symbol: symbol in the source; empty if it has none.
    """

    value: float
    unit: str
    symbol: str


@explained
def parameters(scenario: Scenario) -> dict[str, Parameter]:
    """Returns the constants of particle and material of a scenario, and those that follow from them, by name.

    ``monograin models --parameters FILE`` prints the same constants.
    """
    found = scenario._core.parameters()
    return Named({name: Parameter(value, unit, symbol) for name, value, unit, symbol in found})


def schema() -> dict[str, Any]:
    """Returns the JSON Schema (draft 7) of scenario files, for editors and validators."""
    content: dict[str, Any] = json.loads(_core.schema())
    return content


def scenario_folder() -> pathlib.Path:
    """Returns the folder of the ready scenarios; it contains folders ``sweeps``, ``calibrate`` and ``design``."""
    return pathlib.Path(__file__).parent / "scenarios"


def scenarios() -> list[str]:
    """Returns the names of the ready scenarios."""
    return sorted(path.stem for path in scenario_folder().glob("*.toml"))


def scenario(name: str = "die") -> Scenario:
    """Returns a ready scenario.

    Args:
        name: one of :func:`scenarios`.

    Raises:
        KeyError: for an unknown name; the message suggests the nearest ones.
    """
    if name not in scenarios():
        raise KeyError(unknown(name, scenarios()))
    return Scenario.load(scenario_folder() / f"{name}.toml")

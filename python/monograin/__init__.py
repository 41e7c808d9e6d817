"""Mechanics of a single particle under contact.

>>> import monograin as mg
>>> run = mg.scenario("die").replace({"material.yield_stress": "30 MPa"}).run()
>>> run.status
'complete'

All numbers are in SI units. A str such as ``"30 MPa"`` has a unit of its own.
"""

from . import laws
from ._core import __version__
from .catalogue import Key, Model, Parameter, models, parameters, scenario, scenario_folder, scenarios, schema
from .elements import Continuum, continuum
from .errors import Fault, Interrupted, ScenarioError, SolverError
from .prepared import Prepared
from .runs import Run, Scenario
from .studies import (
    Calibration,
    Comparison,
    CurveDifference,
    Data,
    Design,
    ExpectedErrors,
    FittedParameter,
    Gap,
    Sweep,
    calibrate,
    compare,
    design,
    read_data,
    sensitivity,
    sweep,
)
from .tables import Table

__all__ = [
    "Calibration",
    "Comparison",
    "Continuum",
    "CurveDifference",
    "Data",
    "Design",
    "ExpectedErrors",
    "Fault",
    "FittedParameter",
    "Gap",
    "Interrupted",
    "Key",
    "Model",
    "Parameter",
    "Prepared",
    "Run",
    "Scenario",
    "ScenarioError",
    "SolverError",
    "Sweep",
    "Table",
    "__version__",
    "calibrate",
    "compare",
    "continuum",
    "design",
    "laws",
    "models",
    "parameters",
    "read_data",
    "scenario",
    "scenario_folder",
    "scenarios",
    "schema",
    "sensitivity",
    "sweep",
]

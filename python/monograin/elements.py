"""Finite elements beside a law."""

from __future__ import annotations

import os
from typing import Any, Mapping, NamedTuple, Optional, Union

from . import _core
from ._inputs import explained
from .runs import Path, Run, Scenario, checked
from .tables import Table


class Continuum(NamedTuple):
    """Result of :func:`continuum`: finite elements, the law, and how far they are apart.

    A notebook shows the differences.

    Attributes:
        run: the :class:`Run` of the finite elements. Its columns are ``time``, ``volume`` of the particle, ``work`` of the
            walls by the trapezoidal rule, and displacement, overlap, force, contact radius and mean pressure of each
            contact class. It has no events, and no profiles. ``run.info["elements"]`` has the version of CalculiX, the
            mesh, and the number of elements.
        law: the :class:`Run` of the law, whose walls the finite elements follow.
        differences: a row for force and contact radius of each contact class (``column``): the largest difference between
            the law and the finite elements in ``loading``, where the first class that moves is as deep as ever before, and
            in ``unloading``, elsewhere; and ``mesh_error``, an estimate of the finite elements' own error, with
            ``error=True``. All are over the largest value by finite elements; nan: there are none.
    """

    run: Run
    law: Run
    differences: Table

    def _repr_html_(self) -> str:
        return self.differences._repr_html_()


@explained
def continuum(
    source: Union[Scenario, Run, Path, Mapping[str, Any]],
    folder: Optional[Path] = None,
    *,
    mesh: str = "medium",
    error: bool = False,
    keep: bool = False,
    check: bool = True,
) -> Continuum:
    """Computes the particle of a scenario by finite elements, beside its law, as ``monograin continuum`` does.

    The particle is a homogeneous sphere between rigid walls without friction and adhesion, at finite strain. The walls move
    as in the run of the law, also where a force drives them. What the material lacks, and rows of the law that are far
    apart, are ``run.warnings``.

    The program ``ccx`` of CalculiX (Dhondt, 2004), on Debian the package ``calculix-ccx``, computes it in a process of its
    own. That takes from seconds to many minutes; other threads continue.

    >>> found = mg.continuum("scenarios/hertz.toml", mesh="coarse")
    >>> found.run.plot("axial.force", label="finite elements")

    Args:
        source: a :class:`Scenario`, its dict or its file; or a :class:`Run` of this process, whose law is
            then not run again. A run that was loaded, and one of finite elements, stands for its scenario.
        folder: folder for the files of the run, as the command leaves them; None: no file stays. Files of an earlier run
            are replaced; others stay.
        mesh: ``"coarse"``, ``"medium"`` or ``"fine"``.
        error: True to compute on the next coarser mesh as well, and to estimate the error of the elements.
        keep: True to leave the files of CalculiX in the folder, too.
        check: True to raise an error if CalculiX gives up. If False, the status of the run is then ``"failed"``, and its
            history ends there.

    Raises:
        ScenarioError: with every fault of the scenario.
        ValueError: for a model or a material that finite elements cannot stand for, a Poisson's ratio above 0.49, walls that
            do not stand in perpendicular pairs that move alike, another mesh, and files to keep without a folder.
        RuntimeError: if ``ccx`` is not on the PATH, and before the computation, if the folder holds another result, or a
            file of yours with the name of one to write, or cannot be written.
        SolverError: if CalculiX gives up and ``check`` is True; the error has the run up to there.
        KeyboardInterrupt: on Ctrl-C, which ends CalculiX; the folder is then as it was.
    """
    if isinstance(source, Run) and isinstance(source._core, _core.Run) and not source._is_of_elements():
        law = source
    else:
        law = _scenario_of(source).run(check=False)
    of_law = law._core
    assert isinstance(of_law, _core.Run)
    core, differences = _core.continuum(of_law, mesh, error, keep, "" if folder is None else os.fspath(folder))
    scenario = law.scenario
    return Continuum(checked(Run(core, lambda: scenario), check), law, Table(differences))


def _scenario_of(source: Union[Scenario, Run, Path, Mapping[str, Any]]) -> Scenario:
    if isinstance(source, Run):
        return source.scenario
    if isinstance(source, Scenario):
        return source
    return Scenario(source) if isinstance(source, Mapping) else Scenario.load(source)

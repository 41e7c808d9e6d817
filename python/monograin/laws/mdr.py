"""Contacts of an elastic-perfectly plastic, adhesive particle by the method of dimensionality reduction.

The functions describe one contact at a given apparent radius. Only a run computes how the apparent radius grows.

Source: Zunker and Kamrin, Part I, doi:10.1016/j.jmps.2023.105492.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._inputs import explained, same
from .._law import Elementwise, law

__all__ = [
    "PeelCurve",
    "elastic_contact_radius",
    "elastic_energy",
    "elastic_force",
    "peel_curve",
    "plastic_contact_radius",
    "plastic_force",
    "plastic_mean_pressure",
    "power_profile_1d",
    "power_profile_3d",
    "power_ratio",
    "pull_off_force",
    "pull_off_radius",
    "yield_overlap",
]


@law
def elastic_force(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike, *, profile: str = "ellipse") -> Elementwise:
    """Returns the force of an elastic contact without adhesion [N].

    Source: Zunker and Kamrin (2024), Part I, eqs. 23 and 25 (parabola), 30 and 31 (ellipse).

    Args:
        modulus: composite modulus E* = E/(1 - nu^2) [Pa], above 0.
        radius: apparent radius R [m], above 0.
        overlap: delta [m]; 0 or less gives 0, more than 2 R nan.
        profile: ``"ellipse"``, as in the source, or ``"parabola"``, which gives Hertz's law.
    """
    return _core.laws.mdr_elastic("force", profile, modulus, radius, overlap)


@law
def elastic_contact_radius(radius: ArrayLike, overlap: ArrayLike, *, profile: str = "ellipse") -> Elementwise:
    """Returns the contact radius of an elastic contact without adhesion [m].

    Source: Zunker and Kamrin (2024), Part I, eqs. 23 and 29.

    Args:
        radius, overlap, profile: as in :func:`elastic_force`.
    """
    return _core.laws.mdr_elastic("contact_radius", profile, 1.0, radius, overlap)


@law
def elastic_energy(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike, *, profile: str = "ellipse") -> Elementwise:
    """Returns the energy that an elastic contact without adhesion stores [J].

    Source: Zunker and Kamrin (2024), Part I, the integral of eqs. 25 and 31.

    Args:
        modulus, radius, overlap, profile: as in :func:`elastic_force`.
    """
    return _core.laws.mdr_elastic("energy", profile, modulus, radius, overlap)


@law
def yield_overlap(
    youngs_modulus: ArrayLike, poisson_ratio: ArrayLike, yield_stress: ArrayLike, radius: ArrayLike
) -> Elementwise:
    """Returns the overlap at which an elastic contact becomes fully plastic [m]; inf if it never does.

    Source: Zunker and Kamrin (2024), Part I, eqs. 40 and 41.

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5].
        yield_stress: Y [Pa], above 0.
        radius: apparent radius R [m], above 0.
    """
    return _core.laws.mdr_yield_overlap(youngs_modulus, poisson_ratio, yield_stress, radius)


@law
def plastic_mean_pressure(yield_stress: ArrayLike, radius: ArrayLike, overlap: ArrayLike) -> Elementwise:
    """Returns the mean pressure of a fully plastic contact, Y (1 + 1.75 exp(-4.4 delta/R)) [Pa].

    Source: Zunker and Kamrin (2024), Part I, eqs. 16, 21 and 28.

    Args:
        yield_stress: Y [Pa], above 0.
        radius: apparent radius R [m], above 0.
        overlap: delta [m].
    """
    # The pressure does not depend on the elastic constants.
    return _core.laws.mdr_plastic("mean_pressure", yield_stress, 0.3, yield_stress, radius, overlap)


@law
def plastic_force(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    overlap: ArrayLike,
) -> Elementwise:
    """Returns the force of a fully plastic contact at its largest overlap [N].

    The apparent radius is taken as constant since first yield. Below :func:`yield_overlap` the result is nan.

    Source: Zunker and Kamrin (2024), Part I, eqs. 16, 21, 28 and 36.

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5].
        yield_stress: Y [Pa], above 0.
        radius: apparent radius R [m], above 0.
        overlap: delta [m].
    """
    return _core.laws.mdr_plastic("force", youngs_modulus, poisson_ratio, yield_stress, radius, overlap)


@law
def plastic_contact_radius(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    overlap: ArrayLike,
) -> Elementwise:
    """Returns the contact radius of a fully plastic contact at its largest overlap [m].

    Source: Zunker and Kamrin (2024), Part I, eqs. 36, 42 and 43.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, overlap: as in :func:`plastic_force`.
    """
    return _core.laws.mdr_plastic("contact_radius", youngs_modulus, poisson_ratio, yield_stress, radius, overlap)


@law
def pull_off_force(
    modulus: ArrayLike,
    radius: ArrayLike,
    surface_energy: ArrayLike,
    *,
    control: str = "force",
    profile: str = "ellipse",
) -> Elementwise:
    """Returns the pull-off force of an elastic adhesive contact [N], which is negative.

    Source: Zunker and Kamrin (2024), Part I, eqs. 11, 14 and 15.

    Args:
        modulus: composite modulus E* [Pa], above 0.
        radius: apparent radius R [m], above 0.
        surface_energy: work of adhesion of particle and wall [J/m^2], above 0.
        control: controlled quantity at pull-off, ``"force"`` or ``"displacement"``.
        profile: ``"ellipse"`` or ``"parabola"``. The parabola gives -(3/2) pi R times the surface energy under force
            control, as Johnson, Kendall and Roberts (1971) do.
    """
    return _core.laws.mdr_pull_off("force", profile, control, modulus, radius, surface_energy)


@law
def pull_off_radius(
    modulus: ArrayLike,
    radius: ArrayLike,
    surface_energy: ArrayLike,
    *,
    control: str = "force",
    profile: str = "ellipse",
) -> Elementwise:
    """Returns the contact radius of an elastic adhesive contact at pull-off [m].

    Source: Zunker and Kamrin (2024), Part I, eq. 15.

    Args:
        modulus, radius, surface_energy, control, profile: as in :func:`pull_off_force`.
    """
    return _core.laws.mdr_pull_off("contact_radius", profile, control, modulus, radius, surface_energy)


class PeelCurve(NamedTuple):
    """Stable states of an adhesive contact whose edge recedes, from the largest contact radius down to pull-off.

    Attributes:
        contact_radius: a [m], shape (points,).
        displacement: of the wall [m] from the position in which it touches the relaxed surface on the axis, shape (points,).
        force: force [N], negative in tension, shape (points,).
    """

    contact_radius: NDArray[np.float64]
    displacement: NDArray[np.float64]
    force: NDArray[np.float64]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PeelCurve) and same(tuple(self), tuple(other))

    def __ne__(self, other: object) -> bool:
        return not self == other


@explained
def peel_curve(
    radii: ArrayLike,
    heights: ArrayLike,
    modulus: float,
    surface_energy: float,
    *,
    control: str = "displacement",
    points: int = 101,
) -> PeelCurve:
    """Returns how an adhesive contact with a measured or computed relaxed profile is pulled off.

    The profile is the surface without load, for example of a flattened particle from finite elements or a profilometer;
    it need not be convex. The compression before must have closed the whole disc up to the last radius. Images, forces and
    the end of stability follow from eqs. 4, 11, 14 and 15; between samples the profile is a cubic in the square of the radius.

    Source: Zunker and Kamrin (2024), Part I, eqs. 4, 11, 14 and 15, and appendix F.2.

    Args:
        radii: distances from the axis [m], shape (n,), from 0 on, ascending, at least five. The last one is the largest
            contact radius.
        heights: gap of the relaxed surface from a flat wall that touches it on the axis [m], shape (n,); only differences count.
        modulus: composite modulus E* = E/(1 - nu^2) [Pa], above 0.
        surface_energy: work of adhesion of particle and wall [J/m^2], above 0.
        control: controlled quantity, ``"displacement"`` or ``"force"``. Under force control the last force is that of pull-off.
        points: number of states, 2 or more.

    Raises:
        ValueError: for samples or numbers that are not admissible, and if the edge is unstable at the largest radius: the
            profile must then be known further out.
    """
    if points < 2:
        raise ValueError(f"points = {points}: expected 2 or more")
    return PeelCurve(*_core.laws.mdr_peel_curve(radii, heights, modulus, surface_energy, control, points))


@law
def power_ratio(exponent: ArrayLike) -> Elementwise:
    """Returns kappa_n = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2): the one-dimensional image of r^n is kappa_n x^n.

    Source: Zunker and Kamrin (2024), Part I, eq. 4 for a power.

    Args:
        exponent: n, 0 or above; not necessarily an integer.
    """
    return _core.laws.mdr_power_ratio(exponent)


@law
def power_profile_1d(coefficient: ArrayLike, exponent: ArrayLike, x: ArrayLike) -> Elementwise:
    """Returns the one-dimensional image C kappa_n x^n of the profile C r^n, in the unit of the profile.

    Source: Zunker and Kamrin (2024), Part I, eq. 4.

    Args:
        coefficient: the factor C of the power.
        exponent: n, 0 or above.
        x: distance from the axis, 0 or above.
    """
    return _core.laws.mdr_power_profile_1d(coefficient, exponent, x)


@law
def power_profile_3d(coefficient: ArrayLike, exponent: ArrayLike, r: ArrayLike) -> Elementwise:
    """Returns the profile (C/kappa_n) r^n whose one-dimensional image is C x^n.

    Source: Zunker and Kamrin (2024), Part I, eq. 5.

    Args:
        coefficient: the factor C of the power.
        exponent: n, 0 or above.
        r: distance from the axis, 0 or above.
    """
    return _core.laws.mdr_power_profile_3d(coefficient, exponent, r)


def __dir__() -> list[str]:
    return __all__

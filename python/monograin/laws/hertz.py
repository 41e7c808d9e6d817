"""Hertz contact of an elastic sphere and a rigid flat wall.

Source: Hertz (1882). Valid while the contact radius is well below the sphere's; this is not checked.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["composite_modulus", "contact_radius", "energy", "force"]


@law
def composite_modulus(youngs_modulus: ArrayLike, poisson_ratio: ArrayLike) -> Elementwise:
    """Returns the composite modulus E* = E/(1 - nu^2) [Pa] of an elastic body against a rigid one.

    Source: Zunker and Kamrin (2024), Part I, eq. 3 with a rigid second body.

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5].
    """
    return _core.laws.composite_modulus(youngs_modulus, poisson_ratio)


@law
def force(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike) -> Elementwise:
    """Returns the normal force F = (4/3) E* sqrt(R) delta^(3/2) [N], positive in compression.

    Source: Hertz (1882); Zunker and Kamrin (2024), Part I, eq. 25.

    Args:
        modulus: composite modulus E* [Pa], above 0; see :func:`composite_modulus`.
        radius: R [m], above 0.
        overlap: delta [m], approach of wall and centre since first touch. Without contact (0 or less) the force is 0.
    """
    return _core.laws.hertz_force(modulus, radius, overlap)


@law
def contact_radius(radius: ArrayLike, overlap: ArrayLike) -> Elementwise:
    """Returns the contact radius a = sqrt(R delta) [m]; 0 without contact.

    Source: Hertz (1882); Zunker and Kamrin (2024), Part I, eq. 23.

    Args:
        radius: R [m], above 0.
        overlap: delta [m].
    """
    return _core.laws.hertz_contact_radius(radius, overlap)


@law
def energy(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike) -> Elementwise:
    """Returns the stored elastic energy (2/5) F delta [J]; 0 without contact.

    Source: Hertz (1882); the integral of the force, Zunker and Kamrin (2024), Part I, eq. 25.

    Args:
        modulus: composite modulus E* [Pa], above 0.
        radius: R [m], above 0.
        overlap: delta [m].
    """
    return _core.laws.hertz_energy(modulus, radius, overlap)


def __dir__() -> list[str]:
    return __all__

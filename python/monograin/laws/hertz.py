"""Hertz contact of an elastic sphere and a rigid flat wall.

Source: Hertz (1882). Valid while the contact radius is well below the sphere's; this is not checked.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core

__all__ = ["composite_modulus", "contact_radius", "energy", "force"]


def composite_modulus(youngs_modulus: ArrayLike, poisson_ratio: ArrayLike) -> Any:
    """Returns the composite modulus E* = E/(1 - nu^2) [Pa] of an elastic body against a rigid one.

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5].
    """
    return _core.laws.composite_modulus(youngs_modulus, poisson_ratio)


def force(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike) -> Any:
    """Returns the normal force F = (4/3) E* sqrt(R) delta^(3/2) [N], positive in compression.

    Args:
        modulus: composite modulus E* [Pa], above 0; see :func:`composite_modulus`.
        radius: R [m], above 0.
        overlap: delta [m], approach of wall and centre since first touch. Without contact (0 or less) the force is 0.
    """
    return _core.laws.hertz_force(modulus, radius, overlap)


def contact_radius(radius: ArrayLike, overlap: ArrayLike) -> Any:
    """Returns the contact radius a = sqrt(R delta) [m]; 0 without contact.

    Args:
        radius: R [m], above 0.
        overlap: delta [m].
    """
    return _core.laws.hertz_contact_radius(radius, overlap)


def energy(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike) -> Any:
    """Returns the stored elastic energy (2/5) F delta [J]; 0 without contact.

    Args:
        modulus: composite modulus E* [Pa], above 0.
        radius: R [m], above 0.
        overlap: delta [m].
    """
    return _core.laws.hertz_energy(modulus, radius, overlap)

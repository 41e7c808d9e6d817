"""Elastic sphere at a rigid flat wall with the curvature of the sphere's profile: Hertz's law and its next terms.

The profile is a series in the distance from the axis. Its first term, the parabola, gives Hertz's law; the source takes
four terms, and ``"inf"`` is the sphere itself. Contacts are independent: other walls do not move the surface under a
contact.

Source: Agarwal and Gonzalez, section 4 and appendix B.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["contact_radius", "energy", "force"]


@law
def force(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike, *, terms: str = "inf") -> Elementwise:
    """Returns the normal force [N], positive in compression; 0 without contact.

    Source: Agarwal and Gonzalez (2018), eqs. 27, 31 and 35; all terms: eq. 19.

    Args:
        modulus: composite modulus E* = E/(1 - nu^2) [Pa], above 0.
        radius: R [m], above 0.
        overlap: delta [m].
        terms: number of terms of the profile, ``"1"`` (Hertz) to ``"4"``, or ``"inf"``.
    """
    return _core.laws.curved_sphere("force", terms, modulus, radius, overlap)


@law
def contact_radius(radius: ArrayLike, overlap: ArrayLike, *, terms: str = "inf") -> Elementwise:
    """Returns the contact radius [m]; 0 without contact.

    Source: Agarwal and Gonzalez (2018), the inverse of eqs. 25, 29 and 33; all terms: eq. 19.

    Args:
        radius: R [m], above 0.
        overlap: delta [m].
        terms: as in :func:`force`.
    """
    return _core.laws.curved_sphere("contact_radius", terms, 1.0, radius, overlap)


@law
def energy(modulus: ArrayLike, radius: ArrayLike, overlap: ArrayLike, *, terms: str = "inf") -> Elementwise:
    """Returns the stored elastic energy, the work of the wall since first touch [J].

    Source: Agarwal and Gonzalez (2018), the integral of eqs. 27, 31 and 35; all terms: of eq. 19.

    Args:
        modulus, radius, overlap, terms: as in :func:`force`.
    """
    return _core.laws.curved_sphere("energy", terms, modulus, radius, overlap)


def __dir__() -> list[str]:
    return __all__

"""Contact law of a compressible plastic particle: linear-exponential loading, power-law unloading.

Quantities are reduced: displacements over the radius R0, forces over pi R0^2 sigma_y0, work over pi R0^3 sigma_y0, where
sigma_y0 is the hydrostatic yield pressure at the reference density. The source's data end at a displacement of 0.5.

Source: Edmans and Sinka, eqs. 6 and 9 to 14, appendix A.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = [
    "exponent",
    "hertz_stiffness",
    "loading_force",
    "loading_work",
    "stiffness",
    "transition",
    "unloading_force",
]


@law
def loading_force(
    stiffness: ArrayLike, transition: ArrayLike, exponent: ArrayLike, displacement: ArrayLike
) -> Elementwise:
    """Returns the force of first loading: k d up to delta_t, then k delta_t exp(a (d - delta_t)).

    Source: Edmans and Sinka (n.d.), eq. 6.

    Args:
        stiffness: k, above 0; see :func:`stiffness`.
        transition: delta_t, above 0; see :func:`transition`.
        exponent: a, above 0; see :func:`exponent`.
        displacement: d of the wall; 0 or less gives 0.
    """
    return _core.laws.compressible_loading_force(stiffness, transition, exponent, displacement)


@law
def loading_work(
    stiffness: ArrayLike, transition: ArrayLike, exponent: ArrayLike, displacement: ArrayLike
) -> Elementwise:
    """Returns the work of first loading since first touch.

    Source: Edmans and Sinka (n.d.), the integral of eq. 6.

    Args:
        stiffness, transition, exponent, displacement: as in :func:`loading_force`.
    """
    return _core.laws.compressible_loading_work(stiffness, transition, exponent, displacement)


@law
def unloading_force(
    stiffness: ArrayLike,
    transition: ArrayLike,
    exponent: ArrayLike,
    hertz_stiffness: ArrayLike,
    largest: ArrayLike,
    displacement: ArrayLike,
    *,
    unloading_exponent: ArrayLike = 1.5,
    stiffness_ratio: ArrayLike = 1.0,
) -> Elementwise:
    """Returns the force of unloading from a largest displacement, fm ((d - d0)/(dm - d0))^alpha.

    Source: Edmans and Sinka (n.d.), eqs. 9 and 11 to 14.

    Args:
        stiffness, transition, exponent: of first loading, as in :func:`loading_force`.
        hertz_stiffness: k_H, above 0; see :func:`hertz_stiffness`.
        largest: dm, above 0.
        displacement: d; the contact is open and the force 0 at d0 and below.
        unloading_exponent: alpha, 1 or above.
        stiffness_ratio: beta, above 0: secant stiffness of the unloading over that of Hertz (eq. 11).
    """
    return _core.laws.compressible_unloading_force(
        stiffness, transition, exponent, hertz_stiffness, unloading_exponent, stiffness_ratio, largest, displacement
    )


@law
def hertz_stiffness(modulus_ratio: ArrayLike, poisson_ratio: ArrayLike) -> Elementwise:
    """Returns the stiffness k_H of Hertz's law f = k_H d^(3/2) for the same material.

    Source: Edmans and Sinka (n.d.), eq. 10.

    Args:
        modulus_ratio: E0/sigma_y0, above 0.
        poisson_ratio: nu0, in (-1, 1).
    """
    return _core.laws.compressible_hertz_stiffness(modulus_ratio, poisson_ratio)


@law
def stiffness(modulus_ratio: ArrayLike, shear_ratio: ArrayLike) -> Elementwise:
    """Returns the stiffness k of the loading law by the source's regression.

    Source: Edmans and Sinka (n.d.), eq. A.1, one coefficient corrected.

    Args:
        modulus_ratio: E0/sigma_y0; 3 to 500 in the source, not checked.
        shear_ratio: Gamma0/sigma_y0; 0.25 to 1 in the source, not checked.
    """
    return _core.laws.compressible_stiffness(modulus_ratio, shear_ratio)


@law
def transition(modulus_ratio: ArrayLike, shear_ratio: ArrayLike) -> Elementwise:
    """Returns the end delta_t of the linear part by the source's regression.

    Source: Edmans and Sinka (n.d.), eq. A.2, one coefficient corrected.

    Args:
        modulus_ratio, shear_ratio: as in :func:`stiffness`; the regression was fitted for moduli from 4.5 on.
    """
    return _core.laws.compressible_transition(modulus_ratio, shear_ratio)


@law
def exponent(modulus_ratio: ArrayLike, shear_ratio: ArrayLike) -> Elementwise:
    """Returns the exponent a of the loading law by the source's regression.

    Source: Edmans and Sinka (n.d.), eq. A.3.

    Args:
        modulus_ratio, shear_ratio: as in :func:`transition`.
    """
    return _core.laws.compressible_exponent(modulus_ratio, shear_ratio)


def __dir__() -> list[str]:
    return __all__

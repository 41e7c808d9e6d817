"""Law of a rigid-plastic sphere that hardens by a power law, sigma = kappa epsilon^mu, between rigid flat walls.

Monotonic loading. The particle is incompressible: in a die or under hydrostatic compression the pressure grows without
bound as the particle fills its cell, and results are nan beyond. ``exponent`` is mu in [0, 1].

Source: Shahin (2021), chapter 3.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["contact_radius", "force", "mean_pressure", "work"]


@law
def force(
    strength: ArrayLike,
    exponent: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the force of one moving wall [N].

    Source: Shahin (2021), eq. 3.45.

    Args:
        strength: kappa [Pa], above 0.
        exponent: mu, in [0, 1].
        radius: R [m], above 0.
        displacement: of the wall [m]; 0 or less gives 0.
        configuration: ``"simple"`` (two opposite walls), ``"die"`` (two opposite walls and four fixed lateral ones) or
            ``"hydrostatic"`` (six walls with equal displacements).

    Raises:
        ValueError: for an exponent outside of [0, 1], or an unknown configuration.
    """
    return _core.laws.hardening("force", configuration, strength, exponent, radius, displacement)


@law
def contact_radius(
    exponent: ArrayLike, radius: ArrayLike, displacement: ArrayLike, *, configuration: str = "simple"
) -> Elementwise:
    """Returns the contact radius at a moving wall [m].

    Source: Shahin (2021), eq. 3.47.

    Args:
        exponent, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.hardening("contact_radius", configuration, 1.0, exponent, radius, displacement)


@law
def mean_pressure(
    strength: ArrayLike,
    exponent: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the mean pressure under a moving wall [Pa].

    Source: Shahin (2021), eqs. 3.48 to 3.59, corrected.

    Args:
        strength, exponent, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.hardening("mean_pressure", configuration, strength, exponent, radius, displacement)


@law
def work(
    strength: ArrayLike,
    exponent: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the work of one moving wall since first touch [J].

    Source: Shahin (2021), the integral of eq. 3.45.

    Args:
        strength, exponent, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.hardening("work", configuration, strength, exponent, radius, displacement)


def __dir__() -> list[str]:
    return __all__

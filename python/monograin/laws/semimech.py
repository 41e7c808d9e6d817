"""Semi-mechanistic law of an elastic-ideally plastic sphere between rigid flat walls.

Monotonic loading from first touch until the particle fills its cell. The regimes are elastic, elastic-plastic and fully
plastic; in a die or under hydrostatic compression also low-compressibility and elastic-volumetric.

Source: Shahin (2021), chapter 2.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core

__all__ = ["contact_radius", "force", "mean_pressure", "work"]


def force(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Any:
    """Returns the force of one moving wall [N].

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5].
        yield_stress: Y [Pa], above 0; E/((1 - nu^2) Y) at least 22.1.
        radius: R [m], above 0.
        displacement: of the wall [m]; 0 or less gives 0, R or more nan.
        configuration: ``"simple"`` (two opposite walls), ``"die"`` (two opposite walls and four fixed lateral ones) or
            ``"hydrostatic"`` (six walls with equal displacements).

    Raises:
        ValueError: for a material outside of these ranges, or an unknown configuration.
    """
    return _core.laws.semimech("force", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement)


def contact_radius(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Any:
    """Returns the contact radius at a moving wall [m] (eqs. 2.13, 2.14).

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech(
        "contact_radius", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement
    )


def mean_pressure(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Any:
    """Returns the mean pressure under a moving wall [Pa].

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech(
        "mean_pressure", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement
    )


def work(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Any:
    """Returns the work of one moving wall since first touch [J].

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech("work", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement)

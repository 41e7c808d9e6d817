"""Semi-mechanistic law of an elastic-ideally plastic sphere between rigid flat walls.

Monotonic loading from first touch until the particle fills its cell. The regimes are elastic, elastic-plastic and fully
plastic; in a die or under hydrostatic compression also low-compressibility and elastic-volumetric.

Source: Shahin (2021), chapter 2.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["contact_radius", "force", "mean_pressure", "work"]


@law
def force(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the force of one moving wall [N].

    Source: Shahin (2021), eq. 2.12, with the contact radius of eq. 2.13 and the pressures of eqs. 2.15 to 2.47.

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


@law
def contact_radius(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the contact radius at a moving wall [m].

    Source: Shahin (2021), eqs. 2.13 and 2.14, the exponent of the latter corrected.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech(
        "contact_radius", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement
    )


@law
def mean_pressure(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the mean pressure under a moving wall [Pa].

    Source: Shahin (2021), eqs. 2.15 to 2.47, eq. 2.24 corrected.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech(
        "mean_pressure", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement
    )


@law
def work(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    displacement: ArrayLike,
    *,
    configuration: str = "simple",
) -> Elementwise:
    """Returns the work of one moving wall since first touch [J].

    Source: Shahin (2021), the integral of eq. 2.12.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius, displacement, configuration: as in :func:`force`.
    """
    return _core.laws.semimech("work", configuration, youngs_modulus, poisson_ratio, yield_stress, radius, displacement)


def __dir__() -> list[str]:
    return __all__

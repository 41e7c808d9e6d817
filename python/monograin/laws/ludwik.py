"""Ludwik's hardening sigma = Y + K eps_pl^(1/n), and the power law sigma = kappa eps^mu nearest to it.

Source: Shahin (2021), eqs. 2.1 to 2.3 and 3.1 to 3.3.
"""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from .._inputs import explained
from .._law import Elementwise, law

__all__ = ["PowerLaw", "power_law", "stress"]


@law
def stress(yield_stress: ArrayLike, strength: ArrayLike, exponent: ArrayLike, plastic_strain: ArrayLike) -> Elementwise:
    """Returns the flow stress [Pa].

    Source: Shahin (2021), eqs. 2.1 to 2.3.

    Args:
        yield_stress: Y [Pa], 0 or above.
        strength: K [Pa], 0 or above.
        exponent: 1/n, in (0, 1].
        plastic_strain: eps_pl, 0 or above.
    """
    return _core.laws.ludwik_stress(yield_stress, strength, exponent, plastic_strain)


class PowerLaw(NamedTuple):
    """The power law sigma = strength eps^exponent.

    Attributes:
        strength: kappa [Pa].
        exponent: mu.
        residual: root mean square difference to Ludwik's stress [Pa].
    """

    strength: float
    exponent: float
    residual: float


@explained
def power_law(
    youngs_modulus: float,
    yield_stress: float,
    strength: float,
    exponent: float,
    *,
    largest_strain: float = 1.0,
    fit: str = "both",
) -> PowerLaw:
    """Returns the power law with the least squared difference to Ludwik's stress over the total strain.

    Source: Shahin (2021), eqs. 2.2, 2.3 and 3.3.

    Args:
        youngs_modulus: E [Pa], above 0; inf for a rigid-plastic material.
        yield_stress: Y [Pa], 0 or above.
        strength: K [Pa], 0 or above.
        exponent: 1/n, in (0, 1].
        largest_strain: end of the range of total strains, above 0.
        fit: ``"both"`` fits strength and exponent; ``"exponent"`` fits the exponent, with the strength Y + K.

    Raises:
        ValueError: for a material outside of these ranges, or if the best exponent is not in [0, 1].
    """
    return PowerLaw(*_core.laws.ludwik_power_law(youngs_modulus, yield_stress, strength, exponent, largest_strain, fit))


def __dir__() -> list[str]:
    return __all__

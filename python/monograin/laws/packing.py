"""Compaction of a packing of soft discs, from jamming until all pores are closed.

The constants of the packing are those of the source. Without ``yield_stress`` the discs are elastic. Results are nan
below jamming.

Source: Nezamabadi et al., doi:10.1007/s40571-021-00391-4.
"""

from __future__ import annotations

import math
from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["coordination_number", "modulus", "plastic_fraction", "stress"]


@law
def stress(
    packing_fraction: ArrayLike,
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    *,
    yield_stress: ArrayLike = math.inf,
    hardening_modulus: ArrayLike = 0.0,
) -> Elementwise:
    """Returns the compressive stress of the packing [Pa].

    Source: Nezamabadi et al. (2022), eqs. 6 and 10.

    Args:
        packing_fraction: Phi, up to 1.
        youngs_modulus: E of the discs [Pa], above 0.
        poisson_ratio: nu of the discs, in (-1, 0.5).
        yield_stress: sigma_y of the discs [Pa], above 0; inf: elastic discs.
        hardening_modulus: H of the discs [Pa], 0 or above.
    """
    return _core.laws.packing(
        "stress", packing_fraction, youngs_modulus, poisson_ratio, yield_stress, hardening_modulus
    )


@law
def modulus(packing_fraction: ArrayLike, youngs_modulus: ArrayLike, poisson_ratio: ArrayLike) -> Elementwise:
    """Returns the modulus M_eff of the packing [Pa].

    Source: Nezamabadi et al. (2022), eqs. 7 to 9.

    Args:
        packing_fraction, youngs_modulus, poisson_ratio: as in :func:`stress`.
    """
    return _core.laws.packing("modulus", packing_fraction, youngs_modulus, poisson_ratio, math.inf, 0.0)


@law
def plastic_fraction(
    packing_fraction: ArrayLike,
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    hardening_modulus: ArrayLike = 0.0,
) -> Elementwise:
    """Returns the share f_p of discs that have yielded.

    Source: Nezamabadi et al. (2022), eq. 11.

    Args:
        packing_fraction, youngs_modulus, poisson_ratio, yield_stress, hardening_modulus: as in :func:`stress`.
    """
    return _core.laws.packing(
        "plastic_fraction", packing_fraction, youngs_modulus, poisson_ratio, yield_stress, hardening_modulus
    )


@law
def coordination_number(packing_fraction: ArrayLike) -> Elementwise:
    """Returns the mean number Z of contacts of a disc.

    Source: Nezamabadi et al. (2022), eq. 17.

    Args:
        packing_fraction: Phi, up to 1.
    """
    # The number does not depend on the discs' material.
    return _core.laws.packing("coordination_number", packing_fraction, 1.0, 0.3, math.inf, 0.0)


def __dir__() -> list[str]:
    return __all__

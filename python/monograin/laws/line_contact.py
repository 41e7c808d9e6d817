"""Elastic cylinder between two rigid flat walls, in plane strain.

The nominal stress is the load per length over the diameter, the strain the approach of the walls over the diameter.
Valid while the contacts are narrower than the radius; beyond, results are nan.

Source: K. L. Johnson, Contact Mechanics (1985), section 5.6.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = ["half_width", "strain", "stress"]


@law
def strain(modulus: ArrayLike, stress: ArrayLike) -> Elementwise:
    """Returns the strain delta/D under a nominal stress.

    Source: Johnson (1985), section 5.6.

    Args:
        modulus: composite modulus E* = E/(1 - nu^2) [Pa], above 0.
        stress: S = P/D [Pa], 0 or above.
    """
    return _core.laws.line_contact_strain(modulus, stress)


@law
def half_width(modulus: ArrayLike, stress: ArrayLike) -> Elementwise:
    """Returns the half width of either contact over the radius, b/R = sqrt(8 S/(pi E*)).

    Source: Johnson (1985), section 5.6.

    Args:
        modulus, stress: as in :func:`strain`.
    """
    return _core.laws.line_contact_half_width(modulus, stress)


@law
def stress(modulus: ArrayLike, strain: ArrayLike) -> Elementwise:
    """Returns the nominal stress S [Pa] at a strain, the inverse of :func:`strain`.

    Source: Johnson (1985), section 5.6.

    Args:
        modulus: composite modulus E* [Pa], above 0.
        strain: delta/D, from 0 to 0.443.
    """
    return _core.laws.line_contact_stress(modulus, strain)


def __dir__() -> list[str]:
    return __all__

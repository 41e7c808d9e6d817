"""Similarity law of a rigid-plastic contact, sigma = kappa epsilon^mu (Biwa and Storakers).

Small strains; the law has no unloading. ``exponent`` is mu = 1/m in [0, 1]; 0 is ideal plasticity.

Source: Shahin (2021), section 2.2 and appendix B.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = [
    "contact_radius",
    "force",
    "mean_pressure",
    "pair_approach",
    "pair_contact_radius",
    "pair_force",
    "pair_strength",
    "pair_work",
    "work",
]


@law
def force(
    strength: ArrayLike, exponent: ArrayLike, radius: ArrayLike, displacement: ArrayLike, *, rule: str = "parabolic"
) -> Elementwise:
    """Returns the force of a sphere at a rigid flat wall [N], as one half of a pair of equal spheres.

    Source: Shahin (2021), eqs. 2.4 and 2.8.

    Args:
        strength: kappa [Pa], above 0.
        exponent: mu, in [0, 1].
        radius: R [m], above 0.
        displacement: of the wall [m]; 0 or less gives 0, R or more nan.
        rule: relation of contact radius and approach: ``"parabolic"`` (eq. 2.5), or ``"corrected"`` with the fourth
            power of the profile (eq. B.24).
    """
    return _core.laws.similarity("force", rule, strength, exponent, radius, displacement)


@law
def contact_radius(
    exponent: ArrayLike, radius: ArrayLike, displacement: ArrayLike, *, rule: str = "parabolic"
) -> Elementwise:
    """Returns the contact radius of a sphere at a rigid flat wall [m].

    Source: Shahin (2021), eq. 2.5, or eq. B.24.

    Args:
        exponent, radius, displacement, rule: as in :func:`force`.
    """
    return _core.laws.similarity("contact_radius", rule, 1.0, exponent, radius, displacement)


@law
def mean_pressure(
    strength: ArrayLike, exponent: ArrayLike, radius: ArrayLike, displacement: ArrayLike, *, rule: str = "parabolic"
) -> Elementwise:
    """Returns the mean pressure k kappa (a/R)^mu of a sphere at a rigid flat wall [Pa].

    Source: Shahin (2021), eqs. 2.4 and 2.8.

    Args:
        strength, exponent, radius, displacement, rule: as in :func:`force`.
    """
    return _core.laws.similarity("mean_pressure", rule, strength, exponent, radius, displacement)


@law
def work(
    strength: ArrayLike, exponent: ArrayLike, radius: ArrayLike, displacement: ArrayLike, *, rule: str = "parabolic"
) -> Elementwise:
    """Returns the work of the wall since first touch [J].

    Source: Shahin (2021), the integral of eq. 2.4.

    Args:
        strength, exponent, radius, displacement, rule: as in :func:`force`.
    """
    return _core.laws.similarity("work", rule, strength, exponent, radius, displacement)


@law
def pair_strength(first: ArrayLike, second: ArrayLike, exponent: ArrayLike) -> Elementwise:
    """Returns the strength of two materials in contact, (kappa_1^(-m) + kappa_2^(-m))^(-1/m) [Pa].

    Source: Shahin (2021), eq. 2.8.

    Args:
        first, second: strengths kappa_1 and kappa_2 [Pa], above 0; one may be inf, for a rigid body.
        exponent: mu = 1/m of both, in [0, 1].
    """
    return _core.laws.similarity_strength(first, second, exponent)


@law
def pair_force(
    strength: ArrayLike,
    exponent: ArrayLike,
    first_radius: ArrayLike,
    second_radius: ArrayLike,
    approach: ArrayLike,
    *,
    rule: str = "parabolic",
) -> Elementwise:
    """Returns the force of two spheres in contact [N].

    Source: Shahin (2021), eqs. 2.4, 2.7 and 2.8.

    Args:
        strength: strength of the pair [Pa], see :func:`pair_strength`.
        exponent: mu, in [0, 1].
        first_radius, second_radius: radii of the spheres [m], above 0; one may be inf, for a flat wall.
        approach: approach of the two centres [m]; 0 or less gives 0.
        rule: as in :func:`force`.
    """
    return _core.laws.similarity_pair("force", rule, strength, exponent, first_radius, second_radius, approach)


@law
def pair_contact_radius(
    exponent: ArrayLike,
    first_radius: ArrayLike,
    second_radius: ArrayLike,
    approach: ArrayLike,
    *,
    rule: str = "parabolic",
) -> Elementwise:
    """Returns the contact radius of two spheres in contact [m].

    Source: Shahin (2021), eqs. 2.5 and 2.7, or eq. B.24.

    Args:
        exponent, first_radius, second_radius, approach, rule: as in :func:`pair_force`.
    """
    return _core.laws.similarity_pair("contact_radius", rule, 1.0, exponent, first_radius, second_radius, approach)


@law
def pair_approach(
    strength: ArrayLike,
    exponent: ArrayLike,
    first_radius: ArrayLike,
    second_radius: ArrayLike,
    force: ArrayLike,
    *,
    rule: str = "parabolic",
) -> Elementwise:
    """Returns the approach of the centres under a force [m], the inverse of :func:`pair_force`.

    Source: Shahin (2021), eq. 2.4, solved for the approach.

    Args:
        strength, exponent, first_radius, second_radius, rule: as in :func:`pair_force`.
        force: force between the spheres [N], 0 or above.
    """
    return _core.laws.similarity_pair("approach", rule, strength, exponent, first_radius, second_radius, force)


@law
def pair_work(
    strength: ArrayLike,
    exponent: ArrayLike,
    first_radius: ArrayLike,
    second_radius: ArrayLike,
    approach: ArrayLike,
    *,
    rule: str = "parabolic",
) -> Elementwise:
    """Returns the work of two spheres in contact since first touch [J].

    Source: Shahin (2021), the integral of eq. 2.4.

    Args:
        strength, exponent, first_radius, second_radius, approach, rule: as in :func:`pair_force`.
    """
    return _core.laws.similarity_pair("work", rule, strength, exponent, first_radius, second_radius, approach)


def __dir__() -> list[str]:
    return __all__

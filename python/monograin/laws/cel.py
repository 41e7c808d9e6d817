"""One contact of model ``cel``: an elastic-perfectly plastic sphere at a rigid flat wall, loaded and unloaded.

The contact presses a dent into the surface; its state is the largest contact radius so far. The overlap is the plastic
indentation and the local elastic displacement. The functions hold for one contact on an undeformed core, while contacts
cover little of the surface.

In a run, the elastic sphere, the core and the other walls act as well. Between two walls, the displacement of a wall is
smaller than the overlap by (g(0) + g(pi)) F/(E R0), which is 0.232 F/(E R0) for nu = 0.3. With this term, the force at a
displacement agrees with that of a run within 1 % up to 0.25 R0 for E/Y = 6.25, 0.11 R0 for 20, 0.06 R0 for 50 and 0.03 R0 for
200, where the core begins to yield. During unloading from 0.02 R0, the force at a displacement differs from that of a
run by up to 0.3 % of its largest value for E/Y = 200 and 0.1 % for 50. The contact radius differs by 1.1 % and 0.2 %
while the force is above a hundredth of the largest, and by more just before contact is lost.

Source: model ``cel``, a law of this workbench; its theory page, section "One contact".
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from .._law import Elementwise, law

__all__ = [
    "indentation",
    "loading_force",
    "loading_overlap",
    "mean_pressure",
    "unloading_contact_radius",
    "unloading_force",
    "yield_overlap",
    "yield_radius",
]


@law
def yield_radius(
    youngs_modulus: ArrayLike, poisson_ratio: ArrayLike, yield_stress: ArrayLike, radius: ArrayLike
) -> Elementwise:
    """Returns the contact radius at which a contact yields, (3/4) pi p_Y R0 Y/E* [m].

    It exceeds R0 for E/Y below 3.03 (1 - nu^2): the contact of such a sphere does not yield.

    Source: theory page of ``cel``, Johnson's parameter at yield.

    Args:
        youngs_modulus: E [Pa], above 0.
        poisson_ratio: nu, in (-1, 0.5]; the law was fitted for 0 to 0.45.
        yield_stress: Y [Pa], above 0; the law was fitted for E/Y of 6.25 to 200.
        radius: R0 [m], above 0.
    """
    return _core.laws.cel_yield("contact_radius", youngs_modulus, poisson_ratio, yield_stress, radius)


@law
def yield_overlap(
    youngs_modulus: ArrayLike, poisson_ratio: ArrayLike, yield_stress: ArrayLike, radius: ArrayLike
) -> Elementwise:
    """Returns the overlap at which a contact yields, the square of :func:`yield_radius` over R0 [m].

    Source: theory page of ``cel``, elastic law on a fresh surface.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
    """
    return _core.laws.cel_yield("overlap", youngs_modulus, poisson_ratio, yield_stress, radius)


@law
def indentation(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    largest_radius: ArrayLike,
) -> Elementwise:
    """Returns the plastic indentation that belongs to a dent [m]: the overlap at which an unloaded contact opens.

    Source: theory page of ``cel``, dent.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        largest_radius: largest contact radius so far [m]; up to :func:`yield_radius` the indentation is 0, above R0 nan.
    """
    return _core.laws.cel_indentation(youngs_modulus, poisson_ratio, yield_stress, radius, largest_radius)


@law
def loading_force(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    contact_radius: ArrayLike,
) -> Elementwise:
    """Returns the force of first loading at a contact radius [N], positive in compression.

    Source: theory page of ``cel``, limit; before yield Hertz (1882).

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        contact_radius: a [m]; 0 or less gives 0, more than R0 nan.
    """
    return _core.laws.cel_loading("force", youngs_modulus, poisson_ratio, yield_stress, radius, contact_radius)


@law
def loading_overlap(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    contact_radius: ArrayLike,
) -> Elementwise:
    """Returns the overlap of first loading at a contact radius [m].

    Source: theory page of ``cel``, dent and limit; before yield Hertz (1882).

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        contact_radius: a [m]; 0 or less gives 0, more than R0 nan.
    """
    return _core.laws.cel_loading("overlap", youngs_modulus, poisson_ratio, yield_stress, radius, contact_radius)


@law
def mean_pressure(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    contact_radius: ArrayLike,
) -> Elementwise:
    """Returns the mean pressure of first loading at a contact radius [Pa].

    Source: theory page of ``cel``, pressure; before yield Hertz (1882).

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        contact_radius: a [m]; 0 or less gives 0, more than R0 nan.
    """
    return _core.laws.cel_loading("mean_pressure", youngs_modulus, poisson_ratio, yield_stress, radius, contact_radius)


@law
def unloading_force(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    largest_radius: ArrayLike,
    overlap: ArrayLike,
) -> Elementwise:
    """Returns the force of unloading and reloading on a dent [N].

    Source: theory page of ``cel``, elastic law.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        largest_radius: largest contact radius so far [m], up to R0; up to :func:`yield_radius` the contact is Hertz's.
        overlap: delta [m]; the contact is open and the result 0 at :func:`indentation` and below. Beyond
            :func:`loading_overlap` of the largest radius the contact would flow, and the result is nan.
    """
    return _core.laws.cel_unloading(
        "force", youngs_modulus, poisson_ratio, yield_stress, radius, largest_radius, overlap
    )


@law
def unloading_contact_radius(
    youngs_modulus: ArrayLike,
    poisson_ratio: ArrayLike,
    yield_stress: ArrayLike,
    radius: ArrayLike,
    largest_radius: ArrayLike,
    overlap: ArrayLike,
) -> Elementwise:
    """Returns the contact radius of unloading and reloading on a dent [m].

    The stiffness of the contact is 2 E* times this radius.

    Source: theory page of ``cel``, elastic law.

    Args:
        youngs_modulus, poisson_ratio, yield_stress, radius: as in :func:`yield_radius`.
        largest_radius, overlap: as in :func:`unloading_force`.
    """
    return _core.laws.cel_unloading(
        "contact_radius", youngs_modulus, poisson_ratio, yield_stress, radius, largest_radius, overlap
    )


def __dir__() -> list[str]:
    return __all__

"""A law of one's own beside those of the package: Tatara's elastic sphere at large compression.

    python3 own_law.py [--points N]

A Python function of arrays is all it takes to hold a law against the package's laws and against runs.
Source of the law: Tatara (1991), J. Eng. Mater. Technol. 113, 285-291, doi:10.1115/1.2903407: the surface of the sphere
also moves under the load of the opposite wall, so that the approach of a wall is less than Hertz's by f(a) F/(pi E).
"""

import argparse

import numpy as np

import monograin as mg

YOUNGS_MODULUS, POISSON_RATIO, RADIUS = 1e9, 0.3, 0.01


def opposite_wall(contact_radius):
    """Displacement of the surface under the opposite load, over F/(pi E) [1/m].

    It is Boussinesq's for a point load at a depth of 2 R, at the edge of the contact.
    """
    square = contact_radius**2 + 4.0 * RADIUS**2
    nu = POISSON_RATIO
    return 2.0 * (1.0 + nu) * RADIUS**2 / square**1.5 + (1.0 - nu**2) / np.sqrt(square)


def own_law(contact_radius):
    """Displacement of a wall [m] and force [N] at a contact radius [m]."""
    modulus = mg.laws.hertz.composite_modulus(YOUNGS_MODULUS, POISSON_RATIO)
    overlap = contact_radius**2 / RADIUS
    force = mg.laws.hertz.force(modulus, RADIUS, overlap)
    return overlap - opposite_wall(contact_radius) * force / (np.pi * YOUNGS_MODULUS), force


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=8, help="of the table [%(default)s]")
    points = parser.parse_args().points

    displacement, force = own_law(np.linspace(0.05, 0.4, points) * RADIUS)
    modulus = mg.laws.hertz.composite_modulus(YOUNGS_MODULUS, POISSON_RATIO)
    hertz = mg.laws.hertz.force(modulus, RADIUS, displacement)
    curved = mg.laws.curved_sphere.force(modulus, RADIUS, displacement)

    # A run in which both walls act on each other through the sphere, at the same displacements.
    nonlocal_run = mg.Scenario(
        {
            "model": "nonlocal",
            "particle": {"radius": RADIUS},
            "material": {"youngs_modulus": YOUNGS_MODULUS, "poisson_ratio": POISSON_RATIO},
            "loading": {
                "configuration": "simple",
                "steps": [{"displacement": float(displacement[-1]), "duration": 1.0}],
            },
        }
    ).run()
    computed = np.interp(displacement, nonlocal_run["axial.displacement"], nonlocal_run["axial.force"])

    print(f"{'delta/R':>8}{'Hertz':>10}{'curved':>10}{'nonlocal':>10}{'own law':>10}   force [N]")
    for row in zip(displacement / RADIUS, hertz, curved, computed, force):
        print(f"{row[0]:8.4f}" + "".join(f"{value:10.1f}" for value in row[1:]))


if __name__ == "__main__":
    main()

"""
A law of your own
=================

Tatara's elastic sphere at large compression, compared with laws of the package and with a run. A law of your own is a
function of arrays.
"""

import argparse

import numpy as np
from matplotlib.figure import Figure

import monograin as mg

parser = argparse.ArgumentParser(
    description="Tatara's elastic sphere beside the laws of the package."
)
parser.add_argument("--points", type=int, default=8, help="of the table [%(default)s]")
options = parser.parse_args()

# %%
# In Tatara's law (1991, J. Eng. Mater. Technol. 113, 285-291, doi:10.1115/1.2903407) the surface of the sphere also
# moves under the load of the opposite wall. The wall's displacement is then less than Hertz's by
# :math:`f(a)\,F/(\pi E)`. The displacement :math:`f` is Boussinesq's for a point load at a depth of :math:`2R`, taken
# at the edge of the contact.

YOUNGS_MODULUS, POISSON_RATIO, RADIUS = 1e9, 0.3, 0.01
modulus = mg.laws.hertz.composite_modulus(YOUNGS_MODULUS, POISSON_RATIO)


def opposite_wall(contact_radius):
    """Displacement of the surface under the opposite load, over F/(pi E) [1/m]."""
    square = contact_radius**2 + 4.0 * RADIUS**2
    nu = POISSON_RATIO
    return 2.0 * (1.0 + nu) * RADIUS**2 / square**1.5 + (1.0 - nu**2) / np.sqrt(square)


def own_law(contact_radius):
    """Displacement of a wall [m] and force [N] at a contact radius [m]."""
    overlap = contact_radius**2 / RADIUS
    force = mg.laws.hertz.force(modulus, RADIUS, overlap)
    pushed_out = opposite_wall(contact_radius) * force / (np.pi * YOUNGS_MODULUS)
    return overlap - pushed_out, force


# %%
# The laws of the package at the same displacements:

displacement, force = own_law(np.linspace(0.05, 0.4, options.points) * RADIUS)
hertz = mg.laws.hertz.force(modulus, RADIUS, displacement)
curved = mg.laws.curved_sphere.force(modulus, RADIUS, displacement)

# %%
# A run of model ``nonlocal``, in which the walls interact through the sphere. A scenario may be a dictionary:

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
computed = np.interp(
    displacement, nonlocal_run["axial.displacement"], nonlocal_run["axial.force"]
)

# %%
# Both descriptions of the interaction of the walls agree:

names = ("Hertz", "curved", "nonlocal", "own law")
print(f"{'delta/R':>8}" + "".join(f"{name:>10}" for name in names) + "   force [N]")
for row in zip(displacement / RADIUS, hertz, curved, computed, force):
    print(f"{row[0]:8.4f}" + "".join(f"{value:10.1f}" for value in row[1:]))

# %%
# Divided by Hertz's force, the four curves differ from the start:

figure = Figure(figsize=(6.0, 4.0), layout="constrained")
axes = figure.add_subplot()
for name, values in zip(names, (hertz, curved, computed, force)):
    axes.plot(displacement / RADIUS, values / hertz, "o-", label=name)
axes.set(xlabel=r"Displacement $\delta_o/R_0$", ylabel="Force over Hertz's")
axes.legend(fontsize="small")
figure

"""
Laws side by side
=================

Force over displacement of one material between two walls, by six laws.
"""

import argparse

import numpy as np
from matplotlib.figure import Figure

import monograin as mg

parser = argparse.ArgumentParser(
    description="Force over displacement of one material between two walls, by six laws."
)
argument = parser.add_argument
argument("-o", "--output", default="laws.png", help=".png, .svg or .pdf [%(default)s]")
argument("--points", type=int, default=200, help="of every curve [%(default)s]")
options = parser.parse_args()

# %%
# The laws are functions of arrays, in SI units. They need no scenario and no run. Model ``mdr`` has two branches: a
# contact is elastic up to the overlap at which it yields.

YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS = 1e9, 0.3, 2e7, 0.01
particle = (YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS)
laws = mg.laws
modulus = laws.hertz.composite_modulus(YOUNGS_MODULUS, POISSON_RATIO)
displacement = np.linspace(0.0, 0.2 * RADIUS, options.points)

plastic = laws.mdr.plastic_force(*particle, displacement)
elastic = laws.mdr.elastic_force(modulus, RADIUS, displacement)
yields_at = laws.mdr.yield_overlap(*particle)
curves = {
    "Hertz": laws.hertz.force(modulus, RADIUS, displacement),
    "elastic, curved sphere": laws.curved_sphere.force(modulus, RADIUS, displacement),
    "MDR at constant radius": np.where(displacement < yields_at, elastic, plastic),
    "similarity, plastic": laws.similarity.force(YIELD_STRESS, 0.0, RADIUS, displacement),
    "semi-mechanistic": laws.semimech.force(*particle, displacement),
    "hardening, mu = 0": laws.hardening.force(YIELD_STRESS, 0.0, RADIUS, displacement),
}

# %%
# Forces over yield stress and square of the radius, at the largest displacement:

scale = YIELD_STRESS * RADIUS**2
for name, force in curves.items():
    print(f"{name:<30} F/(Y R^2) = {force[-1] / scale:9.4f} at displacement/R = 0.2")

# %%
# The elastic laws soon leave the axes: this material yields at a displacement of about a hundredth of its radius.

figure = Figure(figsize=(6.0, 4.0), layout="constrained")
axes = figure.add_subplot()
for name, force in curves.items():
    axes.plot(displacement / RADIUS, force / scale, label=name)
axes.set(xlabel=r"Displacement $\delta_o/R_0$", ylabel=r"Force $F/(Y R_0^2)$")
axes.set_ylim(0.0, 6.0)
axes.legend(fontsize="small")
figure.savefig(options.output)
print(f"-> {options.output}")
figure

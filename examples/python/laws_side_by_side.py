"""Laws side by side: force over displacement of one material between two walls, by six laws.

    python3 laws_side_by_side.py [-o FIGURE] [--points N]
"""

import argparse

import numpy as np

import monograin as mg

YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS = 1e9, 0.3, 2e7, 0.01


def forces(displacement):
    """Force [N] by every law, over the displacement of a wall [m]."""
    laws = mg.laws
    modulus = laws.hertz.composite_modulus(YOUNGS_MODULUS, POISSON_RATIO)
    plastic = laws.mdr.plastic_force(YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS, displacement)
    elastic = laws.mdr.elastic_force(modulus, RADIUS, displacement)
    yields_at = laws.mdr.yield_overlap(YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS)
    return {
        "Hertz": laws.hertz.force(modulus, RADIUS, displacement),
        "elastic, curved sphere": laws.curved_sphere.force(modulus, RADIUS, displacement),
        "MDR at constant radius": np.where(displacement < yields_at, elastic, plastic),
        "similarity, ideally plastic": laws.similarity.force(YIELD_STRESS, 0.0, RADIUS, displacement),
        "semi-mechanistic": laws.semimech.force(YOUNGS_MODULUS, POISSON_RATIO, YIELD_STRESS, RADIUS, displacement),
        "rigid-plastic, mu = 0": laws.hardening.force(YIELD_STRESS, 0.0, RADIUS, displacement),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", default="laws.png", help="figure: .png, .svg or .pdf [%(default)s]")
    parser.add_argument("--points", type=int, default=200, help="of every curve [%(default)s]")
    options = parser.parse_args()

    displacement = np.linspace(0.0, 0.2 * RADIUS, options.points)
    curves = forces(displacement)
    scale = YIELD_STRESS * RADIUS**2
    for name, force in curves.items():
        print(f"{name:<30} F/(Y R^2) = {force[-1] / scale:9.4f} at displacement/R = 0.2")

    try:
        from matplotlib.figure import Figure
    except ImportError:
        print("no figure: matplotlib is missing (Debian package python3-matplotlib)")
        return
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.add_subplot()
    for name, force in curves.items():
        axes.plot(displacement / RADIUS, force / scale, label=name)
    # The elastic laws leave the others far below.
    axes.set(xlabel=r"Displacement $\delta_o/R_0$", ylabel=r"Force $F/(Y R_0^2)$", ylim=(0.0, 6.0))
    axes.legend(fontsize="small")
    figure.savefig(options.output)
    print(f"-> {options.output}")


if __name__ == "__main__":
    main()

"""
Synthetic experiments
=====================

Does a 95 % interval contain the true value in 95 % of experiments? This program answers the question for a machine like
yours, before the experiment: it makes data of a known material, adds the noise and the frame of the machine, fits each
set, and counts. It also shows what noise of the displacement does to a fit that does not know of it.
"""

import argparse

import numpy as np
from matplotlib.figure import Figure

import monograin as mg

parser = argparse.ArgumentParser(
    description="How often intervals contain the truth, in synthetic experiments."
)
argument = parser.add_argument
argument("--sets", type=int, default=8, help="experiments of each kind [%(default)s]")
argument("--seed", type=int, default=1, help="[%(default)s]")
argument("--all", action="store_true", help="all five kinds of experiments, not only two")
options = parser.parse_args()

# %%
# The machine
# -----------
#
# A granule of 0.4 mm, a frame that gives way by 60 nm/N, a load cell with noise of 0.15 N and a displacement with noise
# of 0.2 um. Each step has 60 rows.

MODULUS, YIELD_STRESS = 2e9, 60e6  # Pa
FRAME = 60e-9  # m/N
FORCE_NOISE, TRAVEL_NOISE = 0.15, 0.2e-6  # N, m

LOADING = {"displacement": "0.15 R0", "duration": 60}
HOLD = {"hold": True, "duration": 60}
TWO_UNLOADINGS = [
    LOADING,
    {"force": "2 N", "duration": 60},
    {"displacement": "0.2 R0", "duration": 60},
    {"force": "0.5 N", "duration": 60},
]
HELD = [TWO_UNLOADINGS[0], HOLD, *TWO_UNLOADINGS[1:]]
KINDS = [  # name, steps, whether the frame is fitted
    ("two unloadings, frame known", TWO_UNLOADINGS, False),
    ("two unloadings, frame fitted", TWO_UNLOADINGS, True),
    ("loading only, frame known", [LOADING], False),
    ("with a hold, frame known", HELD, False),
    ("with a hold, frame fitted", HELD, True),
]


def granule(steps):
    """The scenario of an experiment."""
    return mg.Scenario(
        {
            "model": "mdr",
            "particle": {"radius": "0.4 mm"},
            "material": {
                "youngs_modulus": MODULUS,
                "poisson_ratio": 0.35,
                "yield_stress": YIELD_STRESS,
            },
            "loading": {"configuration": "simple", "steps": steps},
            "output": {"points": 60},
        }
    )


# %%
# The experiments
# ---------------
#
# The frame adds its own displacement to that of the wall. Each set of data is fitted twice: with the noise of the
# displacement given, and without.


def errors_and_hits(steps, fits_frame, generator):
    """Relative errors of the modulus, and whether its interval contains the true value.

    Both have the shape (sets, 2).
    """
    scenario = granule(steps)
    history = scenario.run().history
    rows = history["row"] == 0
    force = history["axial.force"][rows]
    travel = history["axial.displacement"][rows] + FRAME * force
    errors = np.empty((options.sets, 2))
    hits = np.empty((options.sets, 2), bool)
    for k in range(options.sets):
        data = {
            "displacement[m]": travel + generator.normal(0.0, TRAVEL_NOISE, len(travel)),
            "force[N]": force + generator.normal(0.0, FORCE_NOISE, len(force)),
        }
        noises = [{}, {"absolute": FORCE_NOISE, "x": TRAVEL_NOISE}]
        for with_x, noise in enumerate(noises):
            read = {"file": data, "x": "displacement[m]", "y": "force[N]"}
            free = {
                "material.youngs_modulus": {"from": "0.1 GPa", "to": "10 GPa"},
                "material.yield_stress": {"from": "1 MPa", "to": "200 MPa"},
            }
            if noise:
                read["noise"] = noise
            if fits_frame:
                free["data.compliance"] = {"from": 0, "to": "500 nm/N"}
            else:
                read["compliance"] = FRAME
            fit = mg.calibrate({"scenario": scenario, "data": read, "free": free})
            modulus = fit.parameters["material.youngs_modulus"]
            errors[k, with_x] = modulus.value / MODULUS - 1.0
            hits[k, with_x] = modulus.interval[0] <= MODULUS <= modulus.interval[1]
    return errors, hits


# %%
# Error of Young's modulus, its scatter, and the share of 95 % intervals that contain the true value: first for fits that
# do not know of the noise of the displacement, then for fits that do.

kinds = KINDS if options.all else KINDS[:2]
errors_of = {}
print(f"{'':28}{'noise of x unknown':>26}{'noise of x given':>26}")
for name, steps, fits_frame in kinds:
    generator = np.random.default_rng(options.seed)
    errors, hits = errors_and_hits(steps, fits_frame, generator)
    errors_of[name] = 100 * errors
    cells = [
        f"{100 * errors[:, k].mean():.1f} % +- {100 * errors[:, k].std():.1f} %,"
        f" {hits[:, k].sum()} of {len(hits)}"
        for k in range(2)
    ]
    print(f"{name:28}{cells[0]:>26}{cells[1]:>26}", flush=True)

# %%
# Each point is the error of one fit. Unknown noise of the displacement shifts the modulus:

figure = Figure(figsize=(6.0, 1.2 + 0.7 * len(kinds)), layout="constrained")
axes = figure.add_subplot()
places = np.arange(len(kinds))
labels = ("noise of x unknown", "noise of x given")
for with_x, (label, marker) in enumerate(zip(labels, "os")):
    x = np.concatenate([errors[:, with_x] for errors in errors_of.values()])
    y = np.repeat(places + 0.2 * with_x - 0.1, options.sets)
    axes.plot(x, y, marker, markerfacecolor="none", label=label)
axes.axvline(0.0, color="0.5", linewidth=0.8)
axes.set_yticks(places, list(errors_of))
axes.set(xlabel="Error of Young's modulus [%]", ylim=(len(kinds) - 0.5, -0.5))
axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2, fontsize="small")
figure

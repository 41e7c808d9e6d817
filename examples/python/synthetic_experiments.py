"""
Synthetic experiments
=====================

Does a 95 % interval contain the true value in 95 % of experiments? This program answers the question for a machine like
yours, before the experiment: it makes data of a known material, adds the noise and the frame of the machine, fits each
set, and counts. It also shows what noise of the displacement does to a fit that does not know of it.
"""

import argparse

import numpy as np

import monograin as mg

parser = argparse.ArgumentParser(description="How often intervals contain the truth, in synthetic experiments.")
parser.add_argument("--sets", type=int, default=8, help="experiments of each kind [%(default)s]")
parser.add_argument("--seed", type=int, default=1, help="[%(default)s]")
parser.add_argument("--all", action="store_true", help="all five kinds of experiments, not only the first two")
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
            "material": {"youngs_modulus": MODULUS, "poisson_ratio": 0.35, "yield_stress": YIELD_STRESS},
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
    """Errors of the modulus, over its true value, and whether its interval contains this; of shape (sets, 2)."""
    scenario = granule(steps)
    history = scenario.run().history
    rows = history["row"] == 0
    force = history["axial.force"][rows]
    travel = history["axial.displacement"][rows] + FRAME * force
    errors, hits = np.empty((options.sets, 2)), np.empty((options.sets, 2), bool)
    for k in range(options.sets):
        data = {
            "displacement[m]": travel + generator.normal(0.0, TRAVEL_NOISE, len(travel)),
            "force[N]": force + generator.normal(0.0, FORCE_NOISE, len(force)),
        }
        for with_x, noise in enumerate([{}, {"absolute": FORCE_NOISE, "x": TRAVEL_NOISE}]):
            read = {"file": data, "x": "displacement[m]", "y": "force[N]", "compliance": FRAME}
            free = {
                "material.youngs_modulus": {"from": "0.1 GPa", "to": "10 GPa"},
                "material.yield_stress": {"from": "1 MPa", "to": "200 MPa"},
            }
            if noise:
                read["noise"] = noise
            if fits_frame:
                del read["compliance"]
                free["data.compliance"] = {"from": 0, "to": "500 nm/N"}
            fit = mg.calibrate({"scenario": scenario, "data": read, "free": free})
            modulus = fit.parameters["material.youngs_modulus"]
            errors[k, with_x] = modulus.value / MODULUS - 1.0
            hits[k, with_x] = modulus.interval[0] <= MODULUS <= modulus.interval[1]
    return errors, hits


# %%
# Error of Young's modulus, its scatter, and the share of 95 % intervals that contain the true value: first for fits that
# do not know of the noise of the displacement, then for fits that do.

print(f"{'':30}{'noise of x unknown':>30}{'noise of x given':>30}")
for name, steps, fits_frame in KINDS if options.all else KINDS[:2]:
    errors, hits = errors_and_hits(steps, fits_frame, np.random.default_rng(options.seed))
    cells = [
        f"{100 * mean:.1f} % +- {100 * scatter:.1f} %, {hit} of {len(hits)}"
        for mean, scatter, hit in zip(errors.mean(axis=0), errors.std(axis=0), hits.sum(axis=0))
    ]
    print(f"{name:30}{cells[0]:>30}{cells[1]:>30}", flush=True)

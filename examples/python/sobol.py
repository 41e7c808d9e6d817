"""
Sobol indices
=============

Which inputs of a die compaction do the largest force and the final radius depend on? The first-order index of an input
is the share of the variance that vanishes when this input is known. The total index is the share that remains when all
other inputs are known.
"""

import argparse
import sys
import time

import numpy as np
from matplotlib.figure import Figure

import monograin as mg

try:
    from scipy import stats
except ImportError:
    sys.exit("scipy is missing (Debian package python3-scipy)")

parser = argparse.ArgumentParser(description="Sobol indices of a die compaction.")
argument = parser.add_argument
argument("--samples", type=int, default=256, help="a power of two [%(default)s]")
argument("--designs", type=int, default=8, help="at least 2 [%(default)s]")
argument("--threads", type=int, default=0, help="0: one for each core [%(default)s]")
argument("--seed", type=int, default=1, help="[%(default)s]")
options = parser.parse_args()

RANGES = {
    "material.youngs_modulus": (0.5e9, 2.0e9),
    "material.poisson_ratio": (0.2, 0.4),
    "material.yield_stress": (30e6, 70e6),
}
COLUMNS = ["max(axial.force)", "end(apparent_radius)"]

# %%
# The design is Saltelli's: two independent samples A and B, and for each input a copy of A with this input from B. N
# samples of k inputs need N (k + 2) runs. Both samples come from one scrambled Sobol sequence.


def saltelli(samples, inputs, generator):
    """Samples of the unit cube: A, B, and A with each column of B.

    Their shape is (inputs + 2, samples, inputs).
    """
    both = stats.qmc.Sobol(2 * inputs, seed=generator).random(samples)
    a, b = both[:, :inputs], both[:, inputs:]
    mixed = [np.where(np.arange(inputs) == k, b, a) for k in range(inputs)]
    return np.array([a, b, *mixed])


# %%
# The estimators are those that Saltelli et al. (2010), Computer Physics Communications 181, 259-270, recommend. The
# mean of the results is subtracted first, which reduces the noise of the first-order estimate.


def indices(results):
    """First-order and total indices from results in the order of the design.

    Their shape is (2, inputs, columns).
    """
    a, b, *mixed = results - results.mean(axis=(0, 1))
    variance = np.concatenate([a, b]).var(axis=0)
    first = [(b * (m - a)).mean(axis=0) for m in mixed]
    total = [0.5 * ((a - m) ** 2).mean(axis=0) for m in mixed]
    return np.array([first, total]) / variance


# %%
# The scatter of several designs, each scrambled anew, gives the confidence intervals of the indices.

lower, upper = np.array(list(RANGES.values())).T
generator = np.random.default_rng(options.seed)
prepared = mg.scenario("die").prepare(RANGES)
begin = time.perf_counter()
estimates = []
for _ in range(options.designs):
    design = lower + (upper - lower) * saltelli(options.samples, len(RANGES), generator)
    samples = design.reshape(-1, len(RANGES))
    results = prepared.map(samples, COLUMNS, threads=options.threads)
    estimates.append(indices(results.reshape(*design.shape[:2], len(COLUMNS))))
runs = options.designs * options.samples * (len(RANGES) + 2)
print(f"{runs} runs in {time.perf_counter() - begin:.2f} s")

# %%
# Mean and 95 % confidence interval (Student's t) of each index:

mean = np.mean(estimates, axis=0)
error = np.std(estimates, axis=0, ddof=1) / np.sqrt(options.designs)
half = stats.t.ppf(0.975, options.designs - 1) * error
for c, column in enumerate(COLUMNS):
    print(f"{column:<26}{'first':>19}{'total':>21}")
    for k, key in enumerate(RANGES):
        cells = [f"{mean[o, k, c]:10.5f} +- {half[o, k, c]:.5f}" for o in (0, 1)]
        print(f"  {key:<24}" + "".join(cells))

# %%
# The total index exceeds the first-order one by the share of interactions. The largest force depends on the yield
# stress most, the final radius on Young's modulus.

figure = Figure(figsize=(8.0, 3.0), layout="constrained")
places = np.arange(len(RANGES))
names = [key.removeprefix("material.").replace("_", "\n") for key in RANGES]
panels = figure.subplots(1, len(COLUMNS), sharey=True)
for c, (axes, column) in enumerate(zip(panels, COLUMNS)):
    for o, label in enumerate(("first order", "total")):
        at, height, bar = places + 0.4 * o - 0.2, mean[o, :, c], half[o, :, c]
        axes.bar(at, height, width=0.4, yerr=bar, label=label)
    axes.set_xticks(places, names)
    axes.set_title(column, fontsize="medium")
figure.axes[0].set_ylabel("Sobol index")
figure.axes[0].legend(fontsize="small")
figure

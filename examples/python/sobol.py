"""Sobol indices: which inputs of a die compaction the largest force and the final radius depend on.

    python3 sobol.py [--samples N] [--threads N] [--seed N]

First-order and total indices by Saltelli's design over a scrambled Sobol sequence, with the estimators that Saltelli et
al. (2010), Computer Physics Communications 181, 259-270, recommend. N samples of k inputs are N (k + 2) runs.
"""

import argparse
import time

import numpy as np

import monograin as mg

RANGES = {
    "material.youngs_modulus": (0.5e9, 2.0e9),
    "material.poisson_ratio": (0.2, 0.4),
    "material.yield_stress": (30e6, 70e6),
}
COLUMNS = ["max(axial.force)", "end(apparent_radius)"]


def saltelli(samples, inputs, seed):
    """Two independent samples A and B of the unit cube, and for each input A with that column of B."""
    try:
        from scipy.stats import qmc

        both = qmc.Sobol(2 * inputs, seed=seed).random(samples)
    except ImportError:  # the estimates need more samples then
        both = np.random.default_rng(seed).random((samples, 2 * inputs))
    a, b = both[:, :inputs], both[:, inputs:]
    mixed = [np.where(np.arange(inputs) == k, b, a) for k in range(inputs)]
    return np.concatenate([a, b, *mixed])


def indices(results, samples, inputs):
    """First-order and total indices, each of shape (inputs, columns)."""
    a, b, *mixed = results.reshape(inputs + 2, samples, -1)
    variance = np.concatenate([a, b]).var(axis=0)
    first = np.array([(b * (m - a)).mean(axis=0) for m in mixed]) / variance
    total = np.array([0.5 * ((a - m) ** 2).mean(axis=0) for m in mixed]) / variance
    return first, total


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=256, help="a power of two [%(default)s]")
    parser.add_argument("--threads", type=int, default=0, help="0: one for each core [%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="[%(default)s]")
    options = parser.parse_args()

    lower, upper = np.array(list(RANGES.values())).T
    design = lower + (upper - lower) * saltelli(options.samples, len(RANGES), options.seed)
    prepared = mg.scenario("die").prepare(RANGES)
    start = time.perf_counter()
    results = prepared.map(design, COLUMNS, threads=options.threads)
    seconds = time.perf_counter() - start
    print(f"{len(design)} runs in {seconds:.2f} s")

    # Without its mean the estimate of the first order has less noise.
    first, total = indices(results - results.mean(axis=0), options.samples, len(RANGES))
    for c, column in enumerate(COLUMNS):
        print(f"{column:<26}{'first':>8}{'total':>8}")
        for k, key in enumerate(RANGES):
            print(f"  {key:<24}{first[k, c]:8.3f}{total[k, c]:8.3f}")


if __name__ == "__main__":
    main()

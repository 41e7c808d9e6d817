"""Calibration by a Markov chain: the posterior of two material constants, against the errors of the linearised fit.

    python3 calibration_mcmc.py [--steps N] [--walkers N] [--seed N] [--tolerance SHARE]

The data are those of the ready calibration `uniaxial`: a particle is pressed between two walls and withdrawn. Noise is
Gaussian with the standard deviation that the fit leaves, and priors are flat between the bounds of the calibration. With
--tolerance the program fails if a standard deviation of the posterior is farther than that share from the standard error
of the fit. A standard deviation of N independent samples is known to 1/sqrt(2 N) only: 1 % takes many thousand.
"""

import argparse
import sys

import numpy as np

import monograin as mg


def scenario_through(displacement):
    """The scenario of the data with a program through their displacements, one second for each way.

    Returns:
        The scenario, whose output times are those of the data, and for each of these the row of its datum.
    """
    turn = int(np.argmax(displacement))
    largest, last = displacement[turn], displacement[-1]
    times = np.where(
        np.arange(len(displacement)) <= turn,
        displacement / largest,
        1.0 + (largest - displacement) / (largest - last),
    )
    moved = np.flatnonzero(times > 0.0)
    scenario = mg.scenario("uniaxial").replace(
        {
            "loading.steps": [
                {"displacement": float(largest), "duration": 1.0},
                {"displacement": float(last), "duration": 1.0},
            ],
            "output": {"times": times[moved]},
        }
    )
    return scenario, moved


class Posterior:
    """Logarithm of the posterior density of the free parameters, up to a constant."""

    def __init__(self, calibration):
        fit = calibration.fit
        self.parameters = calibration.parameters
        self.scenario, self.rows = scenario_through(fit["axial.displacement"])
        self.force = fit["axial.force"][self.rows]
        self.prepared = self.scenario.prepare(self.parameters)
        self.bounds = np.array([parameter.bounds for parameter in self.parameters.values()])
        best = self.residuals(list(calibration.values.values()))
        self.noise = np.sqrt((best**2).sum() / calibration.info["statistics"]["degrees_of_freedom"])

    def residuals(self, values):
        run = self.prepared.run(values)
        force = run["axial.force"]
        # Events and corners have rows of their own beside the output points.
        return force[run["row"] == 0][-len(self.force) :] - self.force

    def __call__(self, values):
        if (values <= self.bounds[:, 0]).any() or (values >= self.bounds[:, 1]).any():
            return -np.inf
        return -0.5 * ((self.residuals(values) / self.noise) ** 2).sum()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=1000, help="of every walker [%(default)s]")
    parser.add_argument("--walkers", type=int, default=32, help="[%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="[%(default)s]")
    parser.add_argument("--tolerance", type=float, help="largest share of a standard error, e.g. 0.01")
    options = parser.parse_args()
    try:
        import emcee
    except ImportError:
        print("skipped: emcee is missing (Debian package python3-emcee)")
        return 0

    calibration = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml")
    posterior = Posterior(calibration)
    values = np.array(list(calibration.values.values()))
    errors = np.array([parameter.standard_error for parameter in calibration.parameters.values()])
    np.random.seed(options.seed)
    start = values + errors * np.random.standard_normal((options.walkers, len(values)))
    # Proposals from a density of the other walkers: successive samples are nearly independent.
    sampler = emcee.EnsembleSampler(options.walkers, len(values), posterior, moves=emcee.moves.KDEMove())
    sampler.run_mcmc(start, options.steps)

    chain = sampler.get_chain(discard=options.steps // 10, flat=True)
    independent = len(chain) / sampler.get_autocorr_time(tol=0).max()
    print(f"{options.walkers * options.steps} runs, {independent:.0f} independent samples, ", end="")
    print(f"each standard deviation known to {100.0 / np.sqrt(2.0 * independent):.1f} %")
    worst = 0.0
    for k, (key, parameter) in enumerate(calibration.parameters.items()):
        deviation = chain[:, k].std(ddof=1)
        difference = deviation / parameter.standard_error - 1.0
        worst = max(worst, abs(difference))
        print(f"{key}: {parameter.value:.6g} +- {parameter.standard_error:.4g} by the fit,", end=" ")
        print(f"{chain[:, k].mean():.6g} +- {deviation:.4g} by the chain ({100.0 * difference:+.2f} %)")
    correlation = np.corrcoef(chain.T)[0, 1]
    print(f"correlation: {calibration.correlation[0, 1]:.4f} by the fit, {correlation:.4f} by the chain")
    if options.tolerance is not None and worst > options.tolerance:
        print(f"a standard deviation differs by more than {100.0 * options.tolerance:g} %")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""
Calibration by a Markov chain
=============================

The posterior of two material constants, compared with the standard errors of ``calibrate``. The data are those of the
ready calibration ``uniaxial``: loading and unloading of a particle between two walls.
"""

import argparse
import sys

import numpy as np
from matplotlib.figure import Figure

import monograin as mg

try:
    import emcee
except ImportError:
    sys.exit("emcee is missing (Debian package python3-emcee)")

parser = argparse.ArgumentParser(
    description="The posterior of two material constants by a Markov chain."
)
argument = parser.add_argument
argument("--steps", type=int, default=1000, help="of every walker [%(default)s]")
argument("--walkers", type=int, default=32, help="[%(default)s]")
argument("--seed", type=int, default=1, help="[%(default)s]")
argument(
    "--tolerance",
    type=float,
    help="fail if a standard error differs by more than this share, e.g. 0.01",
)
options = parser.parse_args()

# %%
# The fit
# -------
#
# ``calibrate`` finds the values with the least sum of squares. It linearises the law in the parameters, which gives the
# standard errors.

calibration = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml")
parameters = calibration.parameters
values = np.array([parameter.value for parameter in parameters.values()])
errors = np.array([parameter.standard_error for parameter in parameters.values()])
for key, parameter in parameters.items():
    print(f"{key}: {parameter.value:.6g} +- {parameter.standard_error:.4g}")

# %%
# A program through the data
# --------------------------
#
# The walls move to the largest displacement and back, one second in each direction. The scenario has an output time for
# each displacement of the data.

fit = calibration.fit
displacement = fit["axial.displacement"]
turn = int(np.argmax(displacement))
largest, last = displacement[turn], displacement[-1]
times = np.where(
    np.arange(len(displacement)) <= turn,
    displacement / largest,
    1.0 + (largest - displacement) / (largest - last),
)
moved = times > 0.0
measured = fit["axial.force"][moved]
prepared = (
    mg.scenario("uniaxial")
    .replace(
        {
            "loading.steps": [
                {"displacement": float(largest), "duration": 1.0},
                {"displacement": float(last), "duration": 1.0},
            ],
            "output": {"times": times[moved]},
        }
    )
    .prepare(parameters)
)

# %%
# The posterior
# -------------
#
# Noise is Gaussian, with the standard deviation of the residuals of the fit. Priors are flat between the bounds of the
# calibration.

bounds = np.array([parameter.bounds for parameter in parameters.values()])


def residuals(values):
    run = prepared.run(values)
    # Rows around events and ends of steps have row = -1 or 1; output points have row = 0.
    return run["axial.force"][run["row"] == 0][-len(measured) :] - measured


degrees_of_freedom = calibration.info["statistics"]["degrees_of_freedom"]
noise = np.sqrt((residuals(values) ** 2).sum() / degrees_of_freedom)


def log_posterior(values):
    if (values <= bounds[:, 0]).any() or (values >= bounds[:, 1]).any():
        return -np.inf
    return -0.5 * ((residuals(values) / noise) ** 2).sum()


# %%
# The chain
# ---------
#
# A walker draws its proposals from a density of the other walkers, so that successive samples are nearly independent.
# The relative error of the standard deviation of N independent samples is 1/sqrt(2 N): 1 % needs 5000 of them.

np.random.seed(options.seed)
start = values + errors * np.random.standard_normal((options.walkers, len(values)))
sampler = emcee.EnsembleSampler(
    options.walkers, len(values), log_posterior, moves=emcee.moves.KDEMove()
)
sampler.run_mcmc(start, options.steps)

chain = sampler.get_chain(discard=options.steps // 10, flat=True)
independent = len(chain) / sampler.get_autocorr_time(tol=0).max()
print(f"{options.walkers * options.steps} runs, {independent:.0f} independent samples,")
print(f"each standard deviation known to {100.0 / np.sqrt(2.0 * independent):.1f} %")

# %%
# The chain against the fit
# -------------------------

mean, deviation = chain.mean(axis=0), chain.std(axis=0, ddof=1)
differences = deviation / errors - 1.0
for k, (key, parameter) in enumerate(parameters.items()):
    print(key)
    print(f"  {parameter.value:.6g} +- {parameter.standard_error:.4g} by the fit")
    share = 100.0 * differences[k]
    print(f"  {mean[k]:.6g} +- {deviation[k]:.4g} by the chain ({share:+.2f} %)")
print("correlation")
print(f"  {calibration.correlation[0, 1]:.4f} by the fit")
print(f"  {np.corrcoef(chain.T)[0, 1]:.4f} by the chain")
if options.tolerance is not None and abs(differences).max() > options.tolerance:
    sys.exit(f"a standard deviation differs by more than {100.0 * options.tolerance:g} %")

# %%
# Every sample of the chain, and the ellipse on which the density that the fit expects is exp(-2) of its maximum:

figure = Figure(figsize=(6.0, 4.0), layout="constrained")
axes = figure.add_subplot()
axes.plot(chain[:, 0] / 1e9, chain[:, 1] / 1e6, ",", label="chain")
factor = np.linalg.cholesky(np.outer(errors, errors) * calibration.correlation)
angle = np.linspace(0.0, 2.0 * np.pi, 200)
ellipse = values[:, np.newaxis] + 2.0 * (factor @ [np.cos(angle), np.sin(angle)])
axes.plot(ellipse[0] / 1e9, ellipse[1] / 1e6, label="fit, twice the standard errors")
axes.set(xlabel="Young's modulus [GPa]", ylabel="Yield stress [MPa]")
axes.legend(fontsize="small", loc="upper left")
figure

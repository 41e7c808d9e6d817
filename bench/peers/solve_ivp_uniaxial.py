#!/usr/bin/env python3
"""Integrates one load-unload history of model `mdr` with SciPy's solve_ivp, beside the time that monograin takes.

The cycle is that of scenarios/uniaxial.toml: two walls press a particle by 0.4 R0 each and are withdrawn until they let
go. Apparent radius and work are integrated over the displacement of a wall; events end the elastic contact at yield
and the history at the loss of contact. Rows are those of monograin's history. Errors are against it: the largest
difference of force, apparent radius, work, or displacement at the loss of contact, over its largest value. Lengths are
in R0, stresses in units of E.

Source: W. Zunker and K. Kamrin (2024), J. Mech. Phys. Solids 183, 105492 and 105493. Numbers of equations are those of
the source; the corrections of docs/theory/mdr.md hold.

Exits with 0 when all was measured, 1 without SciPy, 2 when the program is missing or fails.
"""

import argparse
import csv
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import warnings

try:
    import numpy as np
    import scipy
    from scipy.integrate import solve_ivp
    from scipy.optimize import brentq
except ImportError as error:
    sys.exit(f"solve_ivp_uniaxial.py: {error}; on Debian: apt-get install python3-scipy")

SCENARIO = pathlib.Path(__file__).resolve().parent.parent.parent / "scenarios" / "uniaxial.toml"
# Numbers of the scenario: m, Pa, R0, 1, and the rest in units of E.
RADIUS, YOUNGS_MODULUS, DISPLACEMENT, POISSON_RATIO = 0.01, 1e9, 0.4, 0.3
YIELD_STRESS = 0.04
MODULUS = 1.0 / (1.0 - POISSON_RATIO**2)
# 2/(3 kappa V0) of eq. 38: two walls.
COMPLIANCE = 2.0 * (1.0 - 2.0 * POISSON_RATIO) / (4.0 / 3.0 * math.pi)
YIELD_OVERLAP = brentq(lambda d: 4.0 * MODULUS / (3.0 * math.pi * YIELD_STRESS) * math.sqrt(d) - 1.0
                       - 1.75 * math.exp(-4.4 * d), 0.0, 1.0, xtol=1e-16, rtol=1e-15)  # eqs. 40, 41
AREA_CONSTANT = YIELD_OVERLAP * (YIELD_OVERLAP - 1.0)  # eqs. 42, 43
METHODS = ("RK45", "DOP853", "LSODA", "Radau")


def elastic_force(displacement):
    """Force of an elastic contact (eqs. 30, 31)."""
    theta = 2.0 * math.asin(math.sqrt(max(displacement, 0.0) / 4.0))
    return 2.0 * MODULUS * (theta - math.sin(theta) * math.cos(theta))


def plastic_contact(displacement, radius):
    """Force of a yielded contact (eqs. 28, 36), its derivatives by overlap and radius, pressure, and square of the
    contact radius."""
    overlap = displacement + radius - 1.0
    fit = 1.75 * YIELD_STRESS * math.exp(-4.4 * overlap / radius)
    pressure = YIELD_STRESS + fit
    area = overlap * (2.0 * radius - overlap) + AREA_CONSTANT
    fall = 4.4 * fit * area / radius
    by_overlap = math.pi * (2.0 * pressure * (radius - overlap) - fall)
    by_radius = math.pi * (2.0 * pressure * overlap + fall * overlap / radius)
    return math.pi * pressure * area, by_overlap, by_radius, pressure, area


def elastic_rates(displacement, _):
    """Derivatives of apparent radius and work by the displacement, before yield."""
    return 0.0, 2.0 * elastic_force(displacement)


def plastic_rates(displacement, state):
    """Growth of the radius (eq. 37 with the volume of eq. 38 as the root of its quadratic) and of the work."""
    radius = state[0]
    overlap = displacement + radius - 1.0
    force, by_overlap, by_radius, _, _ = plastic_contact(displacement, radius)
    arm = 1.0 - displacement
    elastic = COMPLIANCE / math.sqrt(1.0 - 4.0 * COMPLIANCE * force * arm)
    by_displacement = elastic * (by_overlap * arm - force) - 1.5 * overlap * (2.0 * radius - overlap)
    slope = 3.0 * radius * (radius - overlap) + elastic * (by_overlap + by_radius) * arm
    return max(-by_displacement / slope, 0.0), 2.0 * force


def unloading_shape(radius):
    """Pressure and square of the contact radius at the maximum, and recovery to the loss (eqs. 28, 33, 34, 36)."""
    _, _, _, pressure, area = plastic_contact(DISPLACEMENT, radius)
    contact_radius = math.sqrt(area)
    height = 4.0 * pressure * contact_radius / MODULUS
    zeta = (radius - (DISPLACEMENT + radius - 1.0) + 0.5 * height) / contact_radius
    s = math.hypot(1.0, zeta)
    moves_centre = (1.0 + zeta / (2.0 * (1.0 - POISSON_RATIO) * s)) / (s + zeta)
    return pressure, area, 0.5 * height * (1.0 - moves_centre)


def unloading_force(back, shape):
    """Force after the walls have gone back (eqs. 29, 30, 35)."""
    pressure, area, recovery = shape
    theta = math.acos(min(max(back / recovery, -1.0), 1.0))
    return 2.0 * pressure * area * (theta - math.sin(theta) * math.cos(theta))


def integrate(method, rtol, rows):
    """One history by solve_ivp.

    rows: displacements of the rows of the elastic contact, the yielded one and the one that unloads. Returns force,
    apparent radius and work at these rows (3, n), displacement at the loss of contact, evaluations of the rates.
    Raises ArithmeticError where the integration fails.
    """

    def solve(rates, span, state, wanted, event=None):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            done = solve_ivp(rates, span, state, method=method, rtol=rtol, atol=0.01 * rtol, events=event,
                             dense_output=True)
        if not done.success:
            raise ArithmeticError(done.message)
        return done, done.sol(wanted)

    def at_yield(displacement, _):
        return displacement - YIELD_OVERLAP

    def at_loss(back, _):
        return back - shape[2]

    at_yield.terminal = at_loss.terminal = True
    loading, first = solve(elastic_rates, (0.0, DISPLACEMENT), (1.0, 0.0), rows[0], at_yield)
    start = loading.t_events[0][0]
    growth, second = solve(plastic_rates, (start, DISPLACEMENT), loading.y[:, -1], rows[1])
    shape = unloading_shape(growth.y[0, -1])
    unloading, third = solve(lambda back, _: (0.0, -2.0 * unloading_force(back, shape)), (0.0, DISPLACEMENT),
                             growth.y[:, -1], DISPLACEMENT - rows[2], at_loss)
    force = [elastic_force(d) for d in rows[0]]
    force += [plastic_contact(d, r)[0] for d, r in zip(rows[1], second[0])]
    force += [unloading_force(DISPLACEMENT - d, shape) for d in rows[2]]
    radius, work = np.concatenate((first, second, third), axis=1)
    return np.array((force, radius, work)), DISPLACEMENT - unloading.t[-1], loading.nfev + growth.nfev + unloading.nfev


def call(program, *arguments):
    """Runs the program. Raises OSError where it fails."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise OSError(f"monograin {arguments[0]} ended with {done.returncode}: {done.stderr.strip()}")


def read_table(path):
    """Rows of a CSV file of the program, each a dict of texts by heading."""
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def measure_program(program, folder):
    """Rows of bench.csv: fastest time of a history in the process of the program, by two of its integrators."""
    call(program, "bench", SCENARIO, "--integrator", "auto,cvode-bdf", "--rtol", "1e-8", "-o", folder)
    return read_table(folder / "bench.csv")


def measure_script(method, rtol, rows):
    """Time of one history in s, and what integrate() returns, or the error that it raises."""
    start = time.perf_counter()
    try:
        result = integrate(method, rtol, rows)
    except (ArithmeticError, ValueError, UserWarning) as error:
        result = error
    return time.perf_counter() - start, result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="monograin", help="the program monograin [that on the PATH]")
    parser.add_argument("--rtol", type=float, nargs="+", default=[1e-4, 1e-6, 1e-8, 1e-10, 1e-12],
                        help="relative tolerances of solve_ivp [1e-4 1e-6 1e-8 1e-10 1e-12]")
    parser.add_argument("--repeat", type=int, default=20, help="rounds, taking turns; the fastest counts [20]")
    options = parser.parse_args()
    if options.repeat < 1:
        parser.error("--repeat has to be 1 or more")
    if shutil.which(options.program) is None:
        parser.error(f"there is no program {options.program}; name its file with --program")

    cases = [(method, rtol) for method in METHODS for rtol in options.rtol]
    own, measured = [], {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        try:
            call(options.program, "run", "--quiet", SCENARIO, "-o", folder / "run")
            history = read_table(folder / "run" / "history.csv")
            branches = (("open", "elastic"), ("fully-plastic",), ("unloading", "separated"))
            parts = [[row for row in history if row["axial.regime"] in names] for names in branches]
            rows = [np.array([float(row["axial.displacement[m]"]) / RADIUS for row in part]) for part in parts]
            for _ in range(options.repeat):
                own.append(measure_program(options.program, folder / "bench"))
                for case in cases:
                    found = measure_script(*case, rows)
                    measured[case] = min(found, measured.get(case, found), key=lambda pair: pair[0])
        except OSError as error:
            print(f"solve_ivp_uniaxial.py: {error}", file=sys.stderr)
            return 2

    columns = (("axial.force[N]", YOUNGS_MODULUS * RADIUS**2), ("apparent_radius[m]", RADIUS),
               ("work[J]", YOUNGS_MODULUS * RADIUS**3))
    expected = np.array([[float(row[name]) / unit for part in parts for row in part] for name, unit in columns])
    largest = np.max(np.abs(expected), axis=1, keepdims=True)

    print(f"one history of {len(history)} rows, fastest of {options.repeat} rounds; SciPy {scipy.__version__}")
    print(f"{'':<22}{'rtol':>8}{'ms':>10}{'error':>10}{'rates':>8}{'over auto':>11}")
    auto = math.inf
    for rounds in zip(*own):
        row = min(rounds, key=lambda one: float(one["fastest[s]"]))
        elapsed = float(row["fastest[s]"])
        auto = min(auto, elapsed)
        print(f"{'monograin ' + row['integrator']:<22}{float(row['rtol']):>8.0e}{1e3 * elapsed:>10.3f}"
              f"{float(row['curve_error']):>10.1e}{row['rhs_evaluations']:>8}{elapsed / auto:>11.3g}")
    for (method, rtol), (elapsed, result) in measured.items():
        name = f"{'solve_ivp ' + method:<22}{rtol:>8.0e}"
        if isinstance(result, Exception):
            print(f"{name}  does not end: {result}")
            continue
        values, loss, count = result
        error = max(np.max(np.abs(values - expected) / largest), abs(loss - rows[2][-1]) / DISPLACEMENT)
        print(f"{name}{1e3 * elapsed:>10.3f}{error:>10.1e}{count:>8}{elapsed / auto:>11.3g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Compresses and unloads many elastic-plastic particles at once in plain NumPy, beside `monograin sweep`.

The cycle is that of scenarios/uniaxial.toml: two walls press a particle by 0.4 R0 each and are withdrawn until they let
go. Members differ in Poisson's ratio and yield stress, on the grid of scenarios/bench/sweep.toml unless options say
otherwise. The law is model `mdr` with its defaults (elliptic indenter, radius_rule "yielded", no adhesion). Lengths
are in R0, stresses in Pa, forces in Pa R0^2 and work in Pa R0^3, unless a name says otherwise.

Source: W. Zunker and K. Kamrin (2024), J. Mech. Phys. Solids 183, 105492 and 105493. Numbers of equations are those of
the source; the corrections of docs/theory/mdr.md hold.

Exits with 0 when both were measured, 1 without NumPy, 2 when the program is missing or fails.
"""

import argparse
import csv
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:
    sys.exit("numpy_uniaxial.py: this interpreter has no numpy; on Debian: apt-get install python3-numpy")

SCENARIO = pathlib.Path(__file__).resolve().parent.parent.parent / "scenarios" / "uniaxial.toml"
RADIUS, YOUNGS_MODULUS, DISPLACEMENT = 0.01, 1e9, 0.4  # of the scenario: m, Pa, R0
VOLUME = 4.0 / 3.0 * np.pi

# Results of a member, their columns in results.csv, and their units in SI.
RESULTS = {
    "apparent radius": ("end.apparent_radius[m]", RADIUS),
    "force at the maximum": ("max.axial.force[N]", RADIUS**2),
    "contact radius at the maximum": ("max.axial.contact_radius[m]", RADIUS),
    "work at the maximum": ("max.work[J]", RADIUS**3),
    "displacement of the last contact": ("end.axial.displacement[m]", RADIUS),
    "dissipated work": ("end.dissipation[J]", RADIUS**3),
}


def yield_overlap(modulus_over_yield):
    """Overlap over radius at yield (eqs. 40, 41), by Newton's method in its root.

    modulus_over_yield: E*/Y, array. Raises ValueError where a member does not yield before the maximum.
    """
    root = np.full_like(modulus_over_yield, 0.1)
    for _ in range(50):
        fit = 1.75 * np.exp(-4.4 * root * root)
        slope = 4.0 / (3.0 * np.pi) * modulus_over_yield
        step = (slope * root - 1.0 - fit) / (slope + 8.8 * root * fit)
        root -= step
        if np.all(np.abs(step) < 1e-9 * root):  # Newton's method has squared the error since
            break
    if not np.all(root * root < DISPLACEMENT):
        raise ValueError("a member does not yield before the largest displacement")
    return root * root


def plastic_contact(yield_stress, radius, overlap, area_constant):
    """Mean pressure, square of the contact radius and force of a yielded contact (eqs. 16, 28, 36).

    Also the derivative of the force by the radius while the wall stands still. Arrays of shapes that fit each other.
    """
    ratio = overlap / radius
    fit = yield_stress * (1.75 * np.exp(-4.4 * ratio))
    pressure = yield_stress + fit
    area = overlap * (2.0 * radius - overlap) + area_constant
    by_radius = np.pi * (2.0 * radius * pressure - 4.4 * fit * area * (1.0 - ratio) / radius)
    return pressure, area, np.pi * pressure * area, by_radius


def compression(compliance, force, displacement):
    """w, and the root of 1 - 4 w in the elastic volume V = V0 (1 + root)/2 (eq. 38, corrected).

    compliance: 1/(3 kappa), 1/Pa.
    """
    w = compliance * (2.0 / VOLUME) * force * (1.0 - displacement)
    return w, np.sqrt(1.0 - 4.0 * w)


def volume_balance(compliance, radius, overlap, displacement, force):
    """Volume without the caps less the elastic volume, over V0: a constant while the radius grows (eq. 37, integrated).

    Also the root of compression().
    """
    w, root = compression(compliance, force, displacement)
    growth = radius - 1.0
    caps = 0.5 * overlap * overlap * (3.0 * radius - overlap)
    return growth * (3.0 + growth * (3.0 + growth)) - caps + 2.0 * w / (1.0 + root), root


def growth_demand(yield_stress, compliance, area_constant, displacement):
    """Derivative of the balance by the displacement of a particle that has not grown (eq. 37).

    Growth begins where it falls to 0. Before, elastic compression outweighs the caps, and the radius never shrinks.
    """
    pressure, area, force, _ = plastic_contact(yield_stress, 1.0, displacement, area_constant)
    stiffness = np.pi * (2.0 * pressure * (1.0 - displacement) - 4.4 * (pressure - yield_stress) * area)
    _, root = compression(compliance, force, displacement)
    elastic = compliance * (2.0 / VOLUME) * (stiffness * (1.0 - displacement) - force) / root
    return elastic - 1.5 * displacement * (2.0 - displacement)


def growth_start(yield_stress, compliance, area_constant, start):
    """Displacement at which the radius begins to grow: that at yield, `start`, or later; by the secant method."""
    begin = start.copy()
    late = growth_demand(yield_stress, compliance, area_constant, start) > 0.0
    if not np.any(late):
        return begin
    law = yield_stress[late], compliance[late], area_constant[late]
    before, now = start[late], start[late] + 0.02
    demand_before = growth_demand(*law, before)
    for _ in range(30):
        demand = growth_demand(*law, now)
        change = demand - demand_before
        step = np.where(change != 0.0, demand * (now - before) / np.where(change != 0.0, change, 1.0), 0.0)
        before, demand_before, now = now, demand, now - step
        if np.max(np.abs(step)) < 1e-7:  # the balance is stationary here: its error is the square of that
            break
    begin[late] = np.clip(now, start[late], DISPLACEMENT)
    return begin


def grown_radius(yield_stress, compliance, area_constant, constant, begin, displacement):
    """Apparent radius under displacements (nodes, members) from where growth begins, `begin`, on; by Newton's method.

    Raises ArithmeticError where it does not converge: the free surface is used up.
    """
    radius = 1.0 + 0.6 * (displacement * displacement - begin * begin)
    for _ in range(30):
        overlap = displacement + radius - 1.0
        _, _, force, force_by_radius = plastic_contact(yield_stress, radius, overlap, area_constant)
        balance, root = volume_balance(compliance, radius, overlap, displacement, force)
        slope = 3.0 * radius * (radius - overlap)
        slope += compliance * (2.0 / VOLUME) * (1.0 - displacement) / root * force_by_radius
        step = (balance - constant) / slope
        radius -= step
        if np.max(np.abs(step)) < 1e-9:  # Newton's method has squared the error since
            return radius
    raise ArithmeticError("the apparent radius does not converge")


def histories(poisson_ratio, yield_stress, nodes):
    """Results of load and unload, one array for each name of RESULTS, for members (arrays of one shape).

    nodes: of the Gauss-Legendre quadrature of the work over the displacement, in which the force of a yielded contact
    is smooth. The work up to yield is in closed form.
    """
    modulus = YOUNGS_MODULUS / (1.0 - poisson_ratio**2)
    compliance = (1.0 - 2.0 * poisson_ratio) / YOUNGS_MODULUS
    start = yield_overlap(modulus / yield_stress)
    area_constant = start * (start - 1.0)  # eqs. 42, 43
    # Work of an elastic contact, 4 E* psi(theta); its force is eq. 30.
    angle = 2.0 * np.arcsin(0.5 * np.sqrt(start))
    sine = np.sin(angle)
    work = 4.0 * modulus * (sine - angle * np.cos(angle) - sine**3 / 3.0)
    # From yield to the begin of growth, which is at yield but for soft and strong members.
    points, weights = np.polynomial.legendre.leggauss(nodes)
    points = 0.5 * (1.0 + points[:, None])
    weights = 0.5 * weights
    begin = growth_start(yield_stress, compliance, area_constant, start)
    late = np.flatnonzero(begin > start)
    if len(late) > 0:
        span = begin[late] - start[late]
        _, _, force, _ = plastic_contact(yield_stress[late], 1.0, start[late] + span * points, area_constant[late])
        work[late] += span * (weights @ force)
    _, _, force, _ = plastic_contact(yield_stress, 1.0, begin, area_constant)
    constant, _ = volume_balance(compliance, 1.0, begin, begin, force)

    # From there to the maximum, which is the last row.
    span = DISPLACEMENT - begin
    displacement = np.append(begin + span * points, np.full((1, len(begin)), DISPLACEMENT), axis=0)
    radius = grown_radius(yield_stress, compliance, area_constant, constant, begin, displacement)
    overlap = displacement + radius - 1.0
    pressure, area, force, _ = plastic_contact(yield_stress, radius, overlap, area_constant)
    work = 2.0 * (work + span * (weights @ force[:-1]))

    # Unloading: the indenter that the maximum leaves (eqs. 28, 36), and the share of the recovery that moves the centre
    # (eqs. 33, 34).
    radius, overlap, pressure, area, force = radius[-1], overlap[-1], pressure[-1], area[-1], force[-1]
    contact_radius = np.sqrt(area)
    height = 4.0 * pressure * contact_radius / modulus
    zeta = (radius - overlap + 0.5 * height) / contact_radius
    s = np.sqrt(1.0 + zeta * zeta)
    moves_centre = (1.0 + zeta / (2.0 * (1.0 - poisson_ratio) * s)) / (s + zeta)
    recovery = 0.5 * (1.0 - moves_centre) * height
    given_back = 2.0 * 4.0 / 3.0 * recovery * pressure * area  # integral of eq. 30 over the unloading, both walls
    return dict(zip(RESULTS, (radius, force, contact_radius, work, DISPLACEMENT - recovery, work - given_back)))


def clocks():
    """Wall time and CPU time of this process and of those that it has waited for, in s. Other work on the machine
    lengthens the first one."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return np.array([time.perf_counter(), sum(one.ru_utime + one.ru_stime for one in used)])


def run_sweep(program, folder, counts, jobs):
    """Runs the same members with the program: clocks() of the command, and the columns of its results.csv."""
    text = f"""scenario = "{SCENARIO}"
design = "grid"
[vary]
"material.poisson_ratio" = {{ from = 0.0, to = 0.45, points = {counts[0]} }}
"material.yield_stress" = {{ from = "5 MPa", to = "160 MPa", points = {counts[1]}, scale = "log" }}
"output.points" = {{ values = [10] }}
"""
    folder.mkdir()
    (folder / "members.toml").write_text(text)
    command = [program, "sweep", str(folder / "members.toml"), "-j", str(jobs), "-o", str(folder / "out")]
    start = clocks()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    elapsed = clocks() - start
    if done.returncode != 0:
        raise OSError(f"monograin sweep ended with {done.returncode}: {done.stderr.strip()}")
    with open(folder / "out" / "results.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = ["material.poisson_ratio[-]", "material.yield_stress[Pa]"] + [column for column, _ in RESULTS.values()]
    return elapsed, {name: np.array([float(row[name]) for row in rows]) for name in names}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="monograin", help="the program monograin [that on the PATH]")
    parser.add_argument("--members", type=int, nargs=2, default=(100, 1000), metavar=("NU", "Y"),
                        help="members over Poisson's ratio and yield stress [100 1000]")
    parser.add_argument("--nodes", type=int, default=8, help="nodes of the quadrature of the work [8]")
    parser.add_argument("--chunk", type=int, default=1000, help="members that are computed together [1000]")
    parser.add_argument("--jobs", type=int, default=1, help="threads of the sweep [1, as NumPy takes here]")
    parser.add_argument("--repeat", type=int, default=3, help="the fastest of so many runs counts [3]")
    options = parser.parse_args()
    if min(*options.members, options.nodes, options.chunk, options.jobs, options.repeat) < 1:
        parser.error("members, nodes, chunk, jobs and repeat have to be 1 or more")
    if shutil.which(options.program) is None:
        parser.error(f"there is no program {options.program}; name its file with --program")

    sweep_time = script_time = np.full(2, np.inf)
    try:
        with tempfile.TemporaryDirectory() as folder:
            for k in range(options.repeat):
                # A folder each: a sweep does not repeat what it finds done.
                path = pathlib.Path(folder) / str(k)
                elapsed, sweep = run_sweep(options.program, path, options.members, options.jobs)
                sweep_time = np.minimum(sweep_time, elapsed)
                members = np.array([sweep["material.poisson_ratio[-]"], sweep["material.yield_stress[Pa]"]])
                count = members.shape[1]
                start = clocks()
                parts = [histories(*members[:, i : i + options.chunk], options.nodes)
                         for i in range(0, count, options.chunk)]
                results = {name: np.concatenate([part[name] for part in parts]) for name in RESULTS}
                script_time = np.minimum(script_time, clocks() - start)
    except (OSError, ValueError, ArithmeticError) as error:
        print(f"numpy_uniaxial.py: {error}", file=sys.stderr)
        return 2

    print(f"{count} members, fastest of {options.repeat} runs; NumPy {np.__version__} on one core, "
          f"the sweep on {options.jobs}")
    print(f"{'':<16}{'us a history':>14}{'CPU us':>10}{'histories/s':>14}")
    for name, (wall, cpu) in (("NumPy", script_time), ("monograin sweep", sweep_time)):
        print(f"{name:<16}{1e6 * wall / count:>14.2f}{1e6 * cpu / count:>10.2f}{count / wall:>14,.0f}")
    wall, cpu = sweep_time / script_time
    print(f"time of the sweep over that of NumPy: {wall:.3g}; CPU time: {cpu:.3g}")
    largest = 0.0
    for name, (column, unit) in RESULTS.items():
        difference = np.max(np.abs(results[name] * unit / sweep[column] - 1.0))
        largest = max(largest, difference)
        print(f"  relative difference of {name:<34}{difference:>10.1e}")
    print(f"largest relative difference: {largest:.2e}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Time of one run of the ready scenario `die`, by every way to call it from Python. Called by tools/python-test."""

import os
import statistics
import subprocess
import tempfile
import time

import numpy as np

import monograin as mg

KEYS = ["material.youngs_modulus", "material.yield_stress"]
COLUMNS = ["max(axial.force)", "end(apparent_radius)"]


def nanoseconds(call, times):
    """Fastest and median time of a call."""
    call(0)
    seen = []
    for k in range(times):
        start = time.perf_counter_ns()
        call(k)
        seen.append(time.perf_counter_ns() - start)
    return min(seen), statistics.median(seen)


def main():
    scenario = mg.scenario("die")
    prepared = scenario.prepare(KEYS)
    draw = np.random.default_rng(1)
    samples = np.column_stack([draw.uniform(0.8e9, 2e9, 2000), draw.uniform(3e7, 8e7, 2000)])
    texts = [
        scenario.text.replace('"1 GPa"', repr(e)).replace('"50 MPa"', repr(y)) for e, y in samples[:300].tolist()
    ]
    program = os.environ["MONOGRAIN_PROGRAM"]
    rows = [
        ("scenario.run()", lambda k: scenario.run(), 300),
        ("prepared.run(values)", lambda k: prepared.run(samples[k]), 300),
        ("Scenario(text).run()", lambda k: mg.Scenario(texts[k]).run(), 300),
        (
            "scenario.replace(...).run()",
            lambda k: scenario.replace(dict(zip(KEYS, samples[k].tolist()))).run(),
            300,
        ),
    ]
    print(f"{'':<34}{'fastest':>14}{'median':>14}  ns")
    for name, call, times in rows:
        print(f"{name:<34}{'{:>14.0f}{:>14.0f}'.format(*nanoseconds(call, times))}")
    for threads in sorted({1, os.cpu_count() or 1}):
        fastest, median = nanoseconds(lambda k: prepared.map(samples, COLUMNS, threads=threads), 5)
        name = f"prepared.map, {threads} thread{'s' if threads > 1 else ''}, per run"
        print(f"{name:<34}{fastest / len(samples):>14.0f}{median / len(samples):>14.0f}")
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", "--quiet", mg.scenario_folder() / "die.toml", "-o", "out"]
        times = nanoseconds(lambda k: subprocess.run(command, cwd=folder, check=True), 30)
        print(f"{'monograin run, a process each':<34}{'{:>14.0f}{:>14.0f}'.format(*times)}")
    hertz, overlap = mg.laws.hertz, np.linspace(0.0, 1e-4, 100_000)
    fastest, median = nanoseconds(lambda k: hertz.force(1e9, 0.01, overlap), 50)
    print(f"{'laws.hertz.force, per element':<34}{fastest / len(overlap):>14.1f}{median / len(overlap):>14.1f}")


if __name__ == "__main__":
    main()

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


def cpu_seconds():
    """CPU time of this process and of those that it has started and waited for."""
    return sum(os.times()[:4])


def measure(name, call, times, count=1):
    """Prints fastest and median wall time and mean CPU time of a call that does `count` things, for each of them."""
    call(0)
    seen = []
    start_cpu = cpu_seconds()
    for k in range(times):
        start = time.perf_counter_ns()
        call(k)
        seen.append(time.perf_counter_ns() - start)
    cpu = 1e9 * (cpu_seconds() - start_cpu) / times
    numbers = (min(seen) / count, statistics.median(seen) / count, cpu / count)
    print(f"{name:<36}" + "".join(f"{number:>14,.1f}" for number in numbers))


def main():
    scenario = mg.scenario("die")
    prepared = scenario.prepare(KEYS)
    draw = np.random.default_rng(1)
    samples = np.column_stack([draw.uniform(0.8e9, 2e9, 1000), draw.uniform(3e7, 8e7, 1000)])
    texts = [scenario.text.replace('"1 GPa"', repr(e)).replace('"50 MPa"', repr(y)) for e, y in samples.tolist()]
    changes = [dict(zip(KEYS, row)) for row in samples.tolist()]

    print(f"{'ns':<36}{'fastest':>14}{'median':>14}{'CPU, mean':>14}")
    measure("scenario.run()", lambda k: scenario.run(), 1000)
    measure("prepared.run(values)", lambda k: prepared.run(samples[k]), 1000)
    measure("Scenario(text).run()", lambda k: mg.Scenario(texts[k]).run(), 1000)
    measure("scenario.replace(...).run()", lambda k: scenario.replace(changes[k]).run(), 1000)
    for threads in sorted({1, os.cpu_count() or 1}):
        name = f"prepared.map, threads={threads}, a run"
        measure(name, lambda k: prepared.map(samples, COLUMNS, threads=threads), 3, len(samples))
    ends = ["end(axial.force)", "end(apparent_radius)"]
    measure("prepared.map of the end, 1 thread", lambda k: prepared.map(samples, ends, threads=1), 5, len(samples))
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ["MONOGRAIN_PROGRAM"], "run", "--quiet", mg.scenario_folder() / "die.toml", "-o", "out"]
        measure("monograin run, a process each", lambda k: subprocess.run(command, cwd=folder, check=True), 100)
    overlap = np.linspace(0.0, 1e-4, 100_000)
    measure("laws.hertz.force, an element", lambda k: mg.laws.hertz.force(1e9, 0.01, overlap), 200, len(overlap))


if __name__ == "__main__":
    main()

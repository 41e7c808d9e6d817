"""Every example runs and says what it should."""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import monograin as mg

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"


def run_example(name: str, *arguments: object, cwd: pathlib.Path) -> str:
    command = [sys.executable, "-W", "error::UserWarning", EXAMPLES / name, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_every_example_has_a_test():
    tested = set(re.findall(r'"(\w+\.py)"', pathlib.Path(__file__).read_text()))
    assert {path.name for path in EXAMPLES.glob("*.py")} == tested


def test_a_first_run_leaves_its_folder(tmp_path):
    pytest.importorskip("matplotlib")
    output = run_example("first_run.py", "-o", "out", cwd=tmp_path)
    assert "<Run complete" in output
    assert {"history.csv", "events.csv", "run.json", "curves.png"} <= {path.name for path in (tmp_path / "out").iterdir()}


def test_laws_side_by_side_draw_a_figure(tmp_path):
    pytest.importorskip("matplotlib")
    output = run_example("laws_side_by_side.py", "-o", "laws.svg", "--points", 50, cwd=tmp_path)
    forces = [float(value) for value in re.findall(r"= +([0-9.]+) at", output)]
    assert len(forces) == 6
    assert all(force > 0.0 for force in forces)
    assert (tmp_path / "laws.svg").stat().st_size > 10_000


def test_the_markov_chain_agrees_with_the_fit(tmp_path):
    pytest.importorskip("emcee")
    pytest.importorskip("matplotlib")
    output = run_example("calibration_mcmc.py", "--steps", 500, cwd=tmp_path)
    known = float(re.search(r"each standard deviation known to ([0-9.]+) %", output)[1])
    differences = [float(value) for value in re.findall(r"by the chain \(([+-][0-9.]+) %\)", output)]
    assert len(differences) == 2
    assert known < 1.5
    assert max(map(abs, differences)) <= 3.0 * known


def indices_by_quadrature(points: int) -> np.ndarray:
    """Sobol indices of the inputs of sobol.py by a Gauss-Legendre grid, of shape (columns, inputs, 2): first, total."""
    ranges = {"youngs_modulus": (0.5e9, 2.0e9), "poisson_ratio": (0.2, 0.4), "yield_stress": (30e6, 70e6)}
    prepared = mg.scenario("die").prepare([f"material.{key}" for key in ranges])
    x, w = np.polynomial.legendre.leggauss(points)
    lower, upper = np.array(list(ranges.values())).T
    grid = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1).reshape(-1, 3)
    samples = lower + (upper - lower) * (1.0 + grid) / 2.0
    values = prepared.map(samples, ["max(axial.force)", "end(apparent_radius)"]).T.reshape(2, points, points, points)

    def mean(of, axes):
        for axis in sorted(axes, reverse=True):
            of = np.moveaxis(of, axis + 1, -1) @ (w / 2.0)
        return of

    values = values - mean(values, (0, 1, 2)).reshape(2, 1, 1, 1)
    variance = mean(values**2, (0, 1, 2))
    first = [mean(mean(values, {0, 1, 2} - {k}) ** 2, (0,)) for k in range(3)]
    rest = [mean(mean(values, (k,)) ** 2, (0, 1)) for k in range(3)]
    return np.array([first, variance - np.array(rest)]).transpose(2, 1, 0) / variance.reshape(2, 1, 1)


def test_sobol_indices_are_those_of_a_quadrature(tmp_path):
    pytest.importorskip("scipy")
    output = run_example("sobol.py", "--samples", 256, "--threads", 2, cwd=tmp_path)
    numbers = re.findall(r"(\d\.\d+) \+- (\d\.\d+)", output)
    assert len(numbers) == 12
    index, half = np.array(numbers, dtype=float).T.reshape(2, 2, 3, 2)
    # One of twenty intervals of 95 % lies beside the number: one and a half times as wide hold all twelve here.
    assert (abs(index - indices_by_quadrature(6)) <= 1.5 * half + 1e-4).all()
    assert half.max() < 0.01


def test_an_own_law_stands_beside_those_of_the_package(tmp_path):
    output = run_example("own_law.py", "--points", 5, cwd=tmp_path)
    rows = [[float(value) for value in line.split()] for line in output.splitlines()[1:]]
    assert len(rows) == 5
    for ratio, hertz, curved, computed, own in rows:
        assert curved <= hertz < own
        # Both laws let each wall move the surface under the other one, by other means.
        assert own == pytest.approx(computed, rel=0.02)


def test_intervals_of_synthetic_experiments_contain_the_truth_where_noise_of_x_is_given(tmp_path):
    output = run_example("synthetic_experiments.py", "--sets", 8, cwd=tmp_path)
    kinds = re.findall(r"% \+- ([0-9.]+) %, (\d+) of 8 .*% \+- ([0-9.]+) %, (\d+) of 8", output)
    assert len(kinds) == 2
    for scatter, hits, scatter_with_x, hits_with_x in kinds:
        assert float(scatter_with_x) < float(scatter)
        # At the level of 95 %, six of eight or fewer are a chance of one in seventeen; five or fewer of one in 170.
        assert int(hits_with_x) >= 6
    assert sum(int(hits) for _, hits, _, _ in kinds) < sum(int(hits) for _, _, _, hits in kinds)

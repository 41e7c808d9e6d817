"""Every example runs and says what it should."""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

import pytest

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
    output = run_example("first_run.py", "-o", "out", cwd=tmp_path)
    assert "<Run complete" in output
    assert {"history.csv", "events.csv", "run.json"} <= {path.name for path in (tmp_path / "out").iterdir()}


def test_laws_side_by_side_draw_a_figure(tmp_path):
    pytest.importorskip("matplotlib")
    output = run_example("laws_side_by_side.py", "-o", "laws.svg", "--points", 50, cwd=tmp_path)
    forces = [float(value) for value in re.findall(r"= +([0-9.]+) at", output)]
    assert len(forces) == 6
    assert all(force > 0.0 for force in forces)
    assert (tmp_path / "laws.svg").stat().st_size > 10_000


def test_the_markov_chain_agrees_with_the_fit(tmp_path):
    pytest.importorskip("emcee")
    # Standard deviations of so short a chain are known to some 5 %.
    output = run_example("calibration_mcmc.py", "--steps", 500, "--tolerance", 0.2, cwd=tmp_path)
    assert len(re.findall(r"by the chain", output)) == 3


def test_sobol_indices_add_up(tmp_path):
    output = run_example("sobol.py", "--samples", 256, "--threads", 2, cwd=tmp_path)
    rows = re.findall(r"material\.\w+ +(-?[0-9.]+) +([0-9.]+)", output)
    assert len(rows) == 6
    for column in (rows[:3], rows[3:]):
        first, total = (sum(float(row[k]) for row in column) for k in (0, 1))
        # Interactions are in none of the first-order indices, and more than once in the total ones.
        assert 0.9 < first < total < 1.1


def test_an_own_law_stands_beside_those_of_the_package(tmp_path):
    output = run_example("own_law.py", "--points", 5, cwd=tmp_path)
    rows = [[float(value) for value in line.split()] for line in output.splitlines()[1:]]
    assert len(rows) == 5
    for ratio, hertz, curved, computed, own in rows:
        assert curved <= hertz < own
        # Both laws let each wall move the surface under the other one, by other means.
        assert own == pytest.approx(computed, rel=0.02)

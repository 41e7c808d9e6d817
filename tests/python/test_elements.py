"""Finite elements by CalculiX, and files of runs for other programs."""

from __future__ import annotations

import copy
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import monograin as mg

# Two walls and few rows: a coarse mesh takes a second.
HERTZ = """
model = "hertz"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "3 GPa"
poisson_ratio = 0.2
[loading]
configuration = "simple"
steps = [{ displacement = "0.004 R0", duration = "1 s" }, { displacement = "0.002 R0", duration = "1 s" }]
[output]
points = 2
"""
needs_calculix = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")


@pytest.fixture
def empty_places(tmp_path, monkeypatch) -> list[pathlib.Path]:
    """The current folder, and that of temporary files: both are empty."""
    places = [tmp_path / "here", tmp_path / "temporary"]
    for place in places:
        place.mkdir()
    monkeypatch.chdir(places[0])
    monkeypatch.setenv("TMPDIR", str(places[1]))
    return places


def put_in_place_of_calculix(script: str, folder: pathlib.Path, monkeypatch) -> None:
    folder.mkdir()
    (folder / "ccx").write_text("#!/bin/sh\n" + script)
    (folder / "ccx").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


@needs_calculix
def test_the_function_leaves_the_files_of_the_command(run_program, tmp_path):
    file = tmp_path / "hertz.toml"
    file.write_text(HERTZ)
    called = run_program("continuum", file, "--mesh", "coarse", "--keep", "-o", "theirs", cwd=tmp_path)
    assert called.returncode == 0, called.stderr
    found = mg.continuum(file, tmp_path / "ours", mesh="coarse", keep=True)
    ours, theirs = (sorted(path.name for path in (tmp_path / side).iterdir()) for side in ("ours", "theirs"))
    assert ours == theirs
    assert {"continuum.inp", "continuum.dat", "continuum.log", "history.csv", "events.csv", "run.json"} < set(ours)
    for name in ("history.csv", "events.csv", "run.json", "continuum.inp"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    loaded = mg.Run.load(tmp_path / "theirs")
    assert loaded == found.run
    # Saving a run that is in memory is the same once more.
    found.run.save(tmp_path / "again")
    for name in ("history.csv", "events.csv", "run.json"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name


@needs_calculix
def test_finite_elements_are_a_run_beside_that_of_the_law(empty_places):
    scenario = mg.Scenario(HERTZ)
    law = scenario.run()
    found = mg.continuum(law, mesh="coarse", error=True)
    assert [list(place.iterdir()) for place in empty_places] == [[], []]
    assert found.law is law
    assert found.run.status == "complete"
    assert found.run.scenario == scenario
    assert found.run.history.header["model"] == "continuum"
    assert len(found.run.events) == 0
    assert_array_equal(found.run["axial.displacement"][-1], law["axial.displacement"][-1])
    # Finite strain makes the sphere stiffer than Hertz, by half the root of displacement/R0.
    deepest = np.argmax(found.run["axial.displacement"])
    hertz = law["axial.force"].max()
    assert found.run["axial.force"][deepest] / hertz == pytest.approx(1.03, abs=0.04)
    differences = found.differences
    assert differences["column"].tolist() == ["axial.force", "axial.contact_radius"]
    assert differences.units == {"column": "", "loading": "-", "unloading": "-", "mesh_error": "-"}
    force = found.run["axial.force"]
    largest = np.abs(np.interp(found.run["time"][: deepest + 1], law["time"], law["axial.force"]) - force[: deepest + 1])
    assert differences["loading"][0] == pytest.approx(largest.max() / force.max(), rel=1e-6)
    assert np.isfinite(differences["mesh_error"]).all()
    elements = found.run.info["elements"]
    assert elements["solver"].startswith("CalculiX ")
    assert (elements["mesh"], elements["law_of"]) == ("coarse", "hertz")
    assert [row["loading"] for row in elements["differences"]] == differences["loading"].tolist()
    comparison = mg.compare(law, found.run, x="axial.displacement", y="axial.force")
    assert 0.0 < comparison.curves[0].linf < 0.1
    for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert again == found
    assert "mesh_error" in found._repr_html_()
    with pytest.raises(RuntimeError, match="finite elements have no profile"):
        found.run.profile(0.5)
    pytest.importorskip("matplotlib")
    assert found.run.plot("axial.force").axes
    pytest.importorskip("pandas")
    assert len(found.run.to_pandas()) == len(found.run)
    found.run.write_vtk("particle")
    assert pathlib.Path("particle/run.pvd").is_file()


def test_a_missing_calculix_is_an_error_that_says_how_to_get_it(die, monkeypatch, empty_places):
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(RuntimeError, match="ccx was not found on the PATH.*apt-get install calculix-ccx"):
        mg.continuum(die, "fe")
    assert [list(place.iterdir()) for place in empty_places] == [[], []]


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("compressible", {}, "model compressible has no material for finite elements; expected one of "),
        ("hardening", {}, r"expected youngs_modulus in \[material\]"),
        ("nonlocal", {"material.poisson_ratio": 0.495}, "expected at most 0.49"),
        ("free-centre", {"loading.centre": "fixed"}, "wall 'punch' has no such partner"),
        ("oblique-die", {}, "perpendicular to each other"),
    ],
)
def test_what_finite_elements_cannot_stand_for_is_refused(name, values, message, tmp_path, monkeypatch, empty_places):
    put_in_place_of_calculix(f"touch '{tmp_path}/called'", tmp_path / "bin", monkeypatch)
    with pytest.raises(ValueError, match=message):
        mg.continuum(mg.scenario(name).replace(values), "fe")
    assert not (tmp_path / "called").exists()
    assert [list(place.iterdir()) for place in empty_places] == [[], []]


def test_arguments_are_checked(die, tmp_path, monkeypatch):
    put_in_place_of_calculix("", tmp_path / "bin", monkeypatch)
    with pytest.raises(ValueError, match="mesh = 'finest': expected one of coarse, medium, fine"):
        mg.continuum(die, mesh="finest")
    with pytest.raises(ValueError, match="no folder for the files of CalculiX"):
        mg.continuum(die, keep=True)
    with pytest.raises(TypeError, match="source: expected "):
        mg.continuum(7)
    with pytest.raises(mg.ScenarioError, match="no such file"):
        mg.continuum(tmp_path / "none.toml")
    (tmp_path / "history.csv").write_text("mine")
    with pytest.raises(RuntimeError, match="history.csv"):
        mg.continuum(die, tmp_path)
    assert (tmp_path / "history.csv").read_text() == "mine"


def test_a_calculix_that_gives_up_is_a_solver_error_with_the_run(die, tmp_path, monkeypatch):
    put_in_place_of_calculix("echo ' *ERROR: too many cutbacks'; exit 201", tmp_path / "bin", monkeypatch)
    with pytest.raises(mg.SolverError, match="ended with code 201; its last words: ERROR: too many cutbacks") as caught:
        mg.continuum(die)
    assert caught.value.run.status == "failed"
    found = mg.continuum(die.to_dict(), tmp_path / "fe", check=False)
    assert (found.run.status, len(found.run), found.law.status) == ("failed", 1, "complete")
    loaded = mg.Run.load(tmp_path / "fe")
    assert loaded.status == "failed"
    # A run that was loaded stands for its scenario, also one of finite elements.
    assert mg.continuum(loaded, check=False).law == die.run()


def test_ctrl_c_ends_calculix_and_leaves_nothing(tmp_path):
    (tmp_path / "temporary").mkdir()
    (tmp_path / "ccx").write_text(
        f"#!/bin/sh\n[ \"$1\" = -v ] && exit 0\necho $$ > '{tmp_path}/process'\nexec sleep 600\n"
    )
    (tmp_path / "ccx").chmod(0o755)
    program = f"""
        import os, pathlib, signal, threading, time
        import monograin as mg

        signal.signal(signal.SIGINT, signal.default_int_handler)
        process = pathlib.Path({str(tmp_path / "process")!r})

        def interrupt():
            while not process.exists() or not process.read_text().endswith("\\n"):
                time.sleep(0.05)
            os.kill(os.getpid(), signal.SIGINT)

        for folder in (None, {str(tmp_path / "fe")!r}):
            process.unlink(missing_ok=True)
            threading.Thread(target=interrupt).start()
            try:
                mg.continuum(mg.scenario("die"), folder, mesh="coarse")
            except KeyboardInterrupt:
                print("interrupted")
            try:
                os.kill(int(process.read_text()), 0)
            except ProcessLookupError:
                print("ended")
    """
    paths = {"PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "TMPDIR": str(tmp_path / "temporary")}
    command = [sys.executable, "-c", textwrap.dedent(program)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, env={**os.environ, **paths})
    assert done.stdout.split() == 2 * ["interrupted", "ended"], done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ccx", "process", "temporary"]
    assert list((tmp_path / "temporary").iterdir()) == []


def test_the_particle_for_paraview_is_that_of_the_program(run_program, tmp_path):
    file = mg.scenario_folder() / "die.toml"
    run_program("run", file, "--set", "output.points=5", "-o", "run", "--quiet", cwd=tmp_path)
    assert run_program("plot", "run", "--vtk", cwd=tmp_path).returncode == 0
    expected = {path.name: path.read_bytes() for path in (tmp_path / "run" / "vtk").iterdir()}
    assert len([name for name in expected if name.startswith("particle-")]) > 5
    mg.Run.load(tmp_path / "run").write_vtk(tmp_path / "loaded")
    mg.Scenario.load(file).replace({"output.points": 5}).run().write_vtk(tmp_path / "made")
    for side in ("loaded", "made"):
        assert {path.name: path.read_bytes() for path in (tmp_path / side).iterdir()} == expected, side


def test_a_particle_replaces_no_file_of_the_user(die, tmp_path):
    (tmp_path / "run.pvd").write_text("mine")
    with pytest.raises(RuntimeError, match="run.pvd"):
        die.run().write_vtk(tmp_path)
    assert (tmp_path / "run.pvd").read_text() == "mine"
    with pytest.raises(ValueError, match="model packing has no particle between walls"):
        mg.scenario("packing").run().write_vtk(tmp_path / "none")
    assert not (tmp_path / "none").exists()
    with pytest.raises(ValueError, match="folder: expected a name"):
        die.run().write_vtk("")


@pytest.mark.parametrize("name", ["hertz", "die"])
def test_the_input_of_lammps_is_that_of_the_program(name, run_program, tmp_path):
    file = mg.scenario_folder() / f"{name}.toml"
    called = run_program("export", "lammps", file, cwd=tmp_path)
    run = mg.Scenario.load(file).run()
    assert "pair_coeff" in called.stdout
    assert run.to_lammps() == called.stdout
    run.save(tmp_path / "run")
    assert mg.Run.load(tmp_path / "run").to_lammps() == called.stdout


def test_a_law_that_lammps_does_not_have_is_refused():
    with pytest.raises(ValueError, match="LAMMPS has no contact law with the equations of model cel"):
        mg.scenario("cel").run().to_lammps()


@pytest.mark.parametrize(("name", "wall"), [("uniaxial", None), ("die", "axial")])
def test_the_table_of_forces_is_that_of_the_program(name, wall, run_program, tmp_path):
    file = mg.scenario_folder() / f"{name}.toml"
    called = run_program("export", "table", file, *([] if wall is None else ["--wall", wall]), cwd=tmp_path)
    table = mg.Scenario.load(file).run().force_table(wall)
    assert table.to_csv() == called.stdout
    contact = wall or "axial"
    assert table.columns == ["branch", f"{contact}.displacement", f"{contact}.force"]
    assert table["branch"][0] == 1


def test_a_table_of_forces_needs_a_wall_that_moves(die):
    with pytest.raises(ValueError, match="there is no contact class 'top'; the scene has axial, lateral"):
        die.run().force_table("top")
    with pytest.raises(ValueError, match="the walls of contact class 'lateral' do not move"):
        die.run().force_table("lateral")
    with pytest.raises(ValueError, match="model packing has no particle between walls"):
        mg.scenario("packing").run().force_table()
    with pytest.raises(TypeError, match="contact_class: expected str or None, not 7"):
        die.run().force_table(7)


@pytest.mark.parametrize("name", ["die", "packing"])
def test_a_table_as_text_is_read_again_bit_by_bit(name, tmp_path):
    history = mg.scenario(name).run().history
    (tmp_path / "history.csv").write_text(history.to_csv())
    assert mg.Table.read_csv(tmp_path / "history.csv") == history

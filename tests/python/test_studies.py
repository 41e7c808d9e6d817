"""Sweeps, calibrations, plans of experiments, comparisons, and what the package tells about models."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
import sys
import tomllib

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import monograin as mg


@pytest.mark.filterwarnings("ignore:.* runs warn:RuntimeWarning")
def test_a_sweep_has_the_table_of_the_program(run_program, tmp_path):
    file = mg.scenario_folder() / "sweeps" / "poisson.toml"
    table = mg.sweep(file, tmp_path / "ours")
    assert run_program("sweep", file, "-o", "theirs", cwd=tmp_path).returncode == 0
    assert (tmp_path / "ours" / "results.csv").read_bytes() == (tmp_path / "theirs" / "results.csv").read_bytes()
    assert len(table) == 40
    assert set(table["status"]) == {"complete"}
    assert table["max.axial.force"].shape == (40,)
    assert table.header["sweep"] == "poisson"


def test_data_of_a_machine_are_read_as_the_program_reads_them(run_program, tmp_path):
    file = mg.scenario_folder() / "calibrate" / "uniaxial.csv"
    called = run_program("data", file, cwd=tmp_path)
    data = mg.read_data(file)
    assert str(data) == data.text == called.stdout
    expected = mg.Table.read_csv(file)
    assert data.table.units == expected.units == {"displacement": "mm", "force": "kN"}
    assert_array_equal(data.table["force"], expected["force"])
    assert (data.lines[0], data.remarks) == (4, [])
    assert data == mg.read_data(file, x=1, y="force") == pickle.loads(pickle.dumps(data))
    assert data != mg.read_data(file, x="force", y=1)
    with pytest.raises(mg.ScenarioError, match="x = way: ") as caught:
        mg.read_data(file, x="way")
    assert caught.value.faults[0].file == str(file)
    with pytest.raises(ValueError, match="x and y are both 'displacement': expected two columns"):
        mg.read_data(file, y="displacement")
    with pytest.raises(mg.ScenarioError, match="no such file"):
        mg.read_data(tmp_path / "none.csv")


def test_data_of_a_machine_can_be_calibrated(tmp_path):
    plan = tomllib.loads((mg.scenario_folder() / "calibrate" / "uniaxial.toml").read_text())
    folder = mg.scenario_folder() / "calibrate"
    plan["scenario"] = (folder / plan["scenario"]).as_posix()
    plan["data"]["file"] = (folder / plan["data"]["file"]).as_posix()
    expected = mg.calibrate(plan)
    plan["data"]["file"] = mg.read_data(plan["data"]["file"]).table
    assert mg.calibrate(plan).values == expected.values


def test_a_sweep_warns_of_runs_that_do_not_complete(tmp_path):
    plan = {"scenario": mg.scenario("hertz"), "vary": {"material.poisson_ratio": {"values": [0.3, 0.6]}}}
    for _ in range(2):
        with pytest.warns(RuntimeWarning, match="1 of 2 runs refused, stopped or failed") as caught:
            mg.sweep(plan, tmp_path / "out")
        assert [warning.filename for warning in caught] == [__file__]


def test_a_sweep_tells_how_many_points_the_constraints_exclude(tmp_path):
    plan = {
        "scenario": (mg.scenario_folder() / "die.toml").as_posix(),
        "constraints": ["material.youngs_modulus > 20 * material.yield_stress"],
        "vary": {
            "material.youngs_modulus": {"values": [1e9, 2e9]},
            "material.yield_stress": {"values": [30e6, 60e6, 90e6]},
        },
    }
    table = mg.sweep(plan, tmp_path)
    assert (len(table), table.left_out) == (4, 2)
    for again in (pickle.loads(pickle.dumps(table)), copy.deepcopy(table)):
        assert again == table
        assert again.left_out == 2


def test_results_in_hdf5_are_those_in_csv(tmp_path):
    file = mg.scenario_folder() / "sweeps" / "poisson.toml"
    with pytest.warns(RuntimeWarning, match="6 of 40 runs warn; run 26: contact caps intersect"):
        expected = mg.sweep(file, tmp_path / "csv")
    with pytest.warns(RuntimeWarning, match="6 of 40 runs warn"):
        table = mg.sweep(file, tmp_path / "hdf5", format="hdf5")
    assert not (tmp_path / "hdf5" / "results.csv").exists()
    assert table.units == expected.units
    for column in expected.columns:
        assert_array_equal(table[column], expected[column])
    assert mg.Table.read_hdf5(tmp_path / "hdf5" / "results.h5") == table
    with pytest.raises(ValueError, match="format = xml: expected one of csv, hdf5"):
        mg.sweep(file, tmp_path / "none", format="xml")
    with pytest.raises(FileNotFoundError):
        mg.Table.read_hdf5(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("a,b\n1,2\n")
    with pytest.raises(RuntimeError, match="cannot be read as a table in HDF5"):
        mg.Table.read_hdf5(tmp_path / "text.h5")


def test_results_in_hdf5_are_read_by_h5py(tmp_path):
    scenario = (mg.scenario_folder() / "die.toml").as_posix()
    plan = {"scenario": scenario, "vary": {"loading.configuration": {"values": ["simple", "die"]}}}
    table = mg.sweep(plan, tmp_path, format="hdf5")
    with h5py.File(tmp_path / "results.h5") as file:
        force = file["outputs/end.axial.force"]
        assert force.dtype == np.float64
        assert force.attrs["unit"] == "N"
        assert_array_equal(force[:], table["end.axial.force"])
        assert list(file["inputs"]) == ["loading.configuration"]
        assert file["inputs/loading.configuration"].asstr()[:].tolist() == ["simple", "die"]
        assert list(file["outputs"]) == table.columns[4:]
        assert file.attrs["design"] == "grid"
        assert file.attrs["scenario_text"] == (mg.scenario_folder() / "die.toml").read_text(encoding="utf-8")


def test_a_table_in_hdf5_that_claims_too_many_cells_is_refused(tmp_path):
    with h5py.File(tmp_path / "large.h5", "w", track_order=True) as file:
        for name in ("a", "b"):  # nothing of them is stored
            column = file.create_dataset(name, shape=600_000_000, dtype="S1", chunks=(1 << 17,))
            column.attrs.update(name=name, unit="")
    with pytest.raises(RuntimeError, match="it is too large; expected at most 1000 million cells"):
        mg.Table.read_hdf5(tmp_path / "large.h5")


def test_an_open_file_of_h5py_is_complete_after_a_sweep(tmp_path):
    scenario = (mg.scenario_folder() / "die.toml").as_posix()
    plan = {"scenario": scenario, "vary": {"loading.configuration": {"values": ["simple", "die"]}}}
    program = f"""
import monograin as mg
mg.sweep({plan!r}, {str(tmp_path / "out")!r}, format="hdf5")
import h5py
file = h5py.h5f.create({str(tmp_path / "open.h5")!r}.encode())
h5py.h5g.create(file, b"a")
h5py.h5i.inc_ref(file)  # not closed before the process ends
"""
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
    with h5py.File(tmp_path / "open.h5") as file:
        assert list(file) == ["a"]


def test_bands_of_a_sweep_are_those_of_the_program(run_program, tmp_path):
    scenario = (mg.scenario_folder() / "die.toml").as_posix()
    file = tmp_path / "spread.toml"
    file.write_text(
        f'scenario = "{scenario}"\ndesign = "lhs"\nruns = 20\n'
        '[vary]\n"material.yield_stress" = { mean = "40 MPa", std = "2 MPa" }\n'
        '[bands]\nx = "axial.displacement"\ny = ["axial.force"]\n'
    )
    assert len(mg.sweep(file, tmp_path / "ours")) == 20
    assert run_program("sweep", file, "-o", "theirs", cwd=tmp_path).returncode == 0
    bands = mg.Table.read_csv(tmp_path / "ours" / "bands.csv")
    assert (tmp_path / "ours" / "bands.csv").read_bytes() == (tmp_path / "theirs" / "bands.csv").read_bytes()
    assert (bands["p5.axial.force"] <= bands["p95.axial.force"]).all()


@pytest.mark.filterwarnings("ignore:.* runs warn:RuntimeWarning")
def test_shards_merge_into_the_same_table(tmp_path):
    file = mg.scenario_folder() / "sweeps" / "poisson.toml"
    whole = mg.sweep(file, tmp_path / "whole")
    assert mg.sweep(file, tmp_path / "parts", shard=(1, 2)) is None
    merged = mg.sweep(file, tmp_path / "parts", shard=(2, 2), threads=1)
    for column in whole.columns:
        assert_array_equal(merged[column], whole[column])
    with pytest.raises(ValueError, match="shard"):
        mg.sweep(file, tmp_path / "parts", shard=(3, 2))


@pytest.mark.filterwarnings("ignore:.* runs warn:RuntimeWarning")
def test_sensitivities_are_those_of_the_program(run_program, tmp_path):
    text = (mg.scenario_folder() / "sweeps" / "sobol-indices.toml").read_text().replace("512", "32")
    file = tmp_path / "few.toml"
    file.write_text(text.replace("../die.toml", str(mg.scenario_folder() / "die.toml")))
    table = mg.sensitivity(file, tmp_path / "ours", confidence=0.9)
    assert run_program("sensitivity", file, "-o", "theirs", "--confidence", "0.9", cwd=tmp_path).returncode == 0
    assert (tmp_path / "ours" / "sensitivity.csv").read_text() == (tmp_path / "theirs" / "sensitivity.csv").read_text()
    assert len(table) == 12
    assert table["total"].max() > 0.5


def test_sensitivities_need_a_design_that_tells_them(tmp_path):
    with pytest.raises(ValueError, match="says nothing of sensitivities"):
        mg.sensitivity(mg.scenario_folder() / "sweeps" / "poisson.toml", tmp_path / "grid")
    assert not (tmp_path / "grid").exists()
    with pytest.raises(ValueError, match="confidence"):
        mg.sensitivity(mg.scenario_folder() / "sweeps" / "sobol-indices.toml", tmp_path / "x", confidence=1.0)


def test_a_sweep_warns_of_numbers_without_units(tmp_path):
    study = {"scenario": mg.scenario("die"), "vary": {"material.yield_stress": {"values": ["40 MPa", 50]}}}
    with pytest.warns(RuntimeWarning, match="yield_stress") as caught:
        mg.sweep(study, tmp_path / "out")
    assert [warning.filename for warning in caught] == [__file__, __file__]
    assert "1 of 2 runs warn" in str(caught[1].message)


def test_a_folder_with_a_file_of_the_user_is_refused(tmp_path):
    (tmp_path / "fit.csv").write_text("mine")
    with pytest.raises(RuntimeError, match="fit.csv"):
        mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml", tmp_path)
    assert (tmp_path / "fit.csv").read_text() == "mine"


def test_a_sweep_with_faults_runs_nothing(tmp_path):
    (tmp_path / "bad.toml").write_text('scenario = "none.toml"\ndesign = "grid"\n')
    with pytest.raises(mg.ScenarioError) as caught:
        mg.sweep(tmp_path / "bad.toml", tmp_path / "out")
    assert caught.value.faults
    assert not (tmp_path / "out").exists()


def test_a_calibration_finds_what_the_program_finds(run_program, tmp_path):
    file = mg.scenario_folder() / "calibrate" / "uniaxial.toml"
    result = mg.calibrate(file, tmp_path / "ours")
    called = run_program("calibrate", file, "-o", "theirs", "--quiet", cwd=tmp_path)
    assert called.returncode == 0
    assert str(result) == called.stdout
    assert result.info == json.loads((tmp_path / "theirs" / "calibration.json").read_text())
    assert (tmp_path / "ours" / "fit.csv").read_bytes() == (tmp_path / "theirs" / "fit.csv").read_bytes()
    modulus = result.parameters["material.youngs_modulus"]
    assert modulus.interval[0] < 1.2e9 < modulus.interval[1]
    assert modulus.at_bound is None
    assert modulus.is_determined
    assert modulus.standard_error == pytest.approx(np.sqrt(result.covariance[0, 0]), rel=1e-12)
    assert_array_equal(np.diag(result.correlation), [1.0, 1.0])
    fitted = mg.Scenario(result.scenario_text)
    again = mg.scenario("uniaxial").replace(result.values)
    assert tomllib.loads(fitted.text)["material"].keys() == tomllib.loads(again.text)["material"].keys()
    assert_array_equal(fitted.run()["axial.force"], again.run()["axial.force"])
    assert "residual" in result.fit


def _uniaxial_fit(data):
    free = {
        "material.youngs_modulus": {"from": "0.1 GPa", "to": "10 GPa"},
        "material.yield_stress": {"from": "1 MPa", "to": "200 MPa"},
    }
    columns = {"x": "displacement[mm]", "y": "force[kN]", "weights": "absolute"}
    return {"scenario": mg.scenario_folder() / "uniaxial.toml", "data": {"file": data, **columns}, "free": free}


@pytest.mark.parametrize("kind", ["path", "table", "arrays", "pandas"])
def test_a_calibration_takes_a_dict_and_data_in_memory(kind):
    csv = mg.scenario_folder() / "calibrate" / "uniaxial.csv"
    expected = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml").values
    displacement, force = np.loadtxt(csv, delimiter=",", skiprows=3, comments="#", unpack=True)
    arrays = {"displacement[mm]": displacement, "force[kN]": force}
    data = {"path": csv, "table": mg.Table.read_csv(csv), "arrays": arrays}
    if kind == "pandas":
        data["pandas"] = pytest.importorskip("pandas").DataFrame(arrays)
    found = mg.calibrate(_uniaxial_fit(data[kind])).values
    assert found == pytest.approx(expected, rel=1e-9)


def test_a_calibration_takes_a_run_and_its_frame():
    truth = mg.scenario("hertz").run()
    for data in (truth, truth.to_pandas()):
        fit = mg.calibrate(
            {
                "scenario": mg.scenario("hertz"),
                "data": {"file": data, "x": "axial.displacement", "y": "axial.force"},
                "free": {"material.youngs_modulus": {"from": 1e9, "to": 1e12}},
            }
        )
        assert fit.values["material.youngs_modulus"] == pytest.approx(70e9, rel=1e-6)
        frame = truth.to_pandas()
        frame["axial.force"] = frame["axial.force"].astype(object)
        frame.loc[3, "axial.force"] = "1,5"
        with pytest.raises(ValueError, match="1,5"):
            mg.calibrate({"scenario": mg.scenario("hertz"), "data": {"file": frame, "x": "axial.displacement", "y": "axial.force"}, "free": {}})
        fit.info.clear()
        assert fit.values


def test_a_study_takes_a_changed_scenario_and_finds_the_files_that_it_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scenario = mg.scenario("compressible").replace({"output.points": 20})
    table = mg.sweep({"scenario": scenario, "vary": {"output.points": {"values": [20, 30]}}}, "swept")
    assert table["end.axial.force"].tolist() == [scenario.run()["axial.force"][-1]] * 2


def test_rows_of_data_in_memory_that_are_nan_are_missing_cells():
    csv = mg.scenario_folder() / "calibrate" / "uniaxial.csv"
    displacement, force = np.loadtxt(csv, delimiter=",", skiprows=3, comments="#", unpack=True)
    full = mg.calibrate(_uniaxial_fit({"displacement[mm]": displacement, "force[kN]": force}))
    with_gap = force.copy()
    with_gap[5] = np.nan
    one_less = mg.calibrate(_uniaxial_fit({"displacement[mm]": displacement, "force[kN]": with_gap}))
    assert len(one_less.fit) == len(full.fit) - 1


def test_data_of_unequal_columns_and_faults_in_a_dict_are_refused():
    with pytest.raises(ValueError, match="equal length"):
        mg.calibrate(_uniaxial_fit({"displacement[mm]": [0.0, 1.0], "force[kN]": [0.0]}))
    wrong = _uniaxial_fit({"displacement[mm]": [0.0, 1.0], "load[kN]": [0.0, 1.0]})
    with pytest.raises(mg.ScenarioError, match="force"):
        mg.calibrate(wrong)
    with pytest.raises(mg.ScenarioError, match="calibration.toml.*fre"):
        mg.calibrate({"scenario": "none.toml", "fre": {}})


def test_a_sweep_and_a_design_take_dicts(tmp_path):
    scenario = mg.scenario_folder() / "uniaxial.toml"
    grid = {"scenario": scenario, "design": "grid", "vary": {"material.yield_stress": {"values": ["30 MPa", "40 MPa"]}}}
    table = mg.sweep(grid, tmp_path / "grid")
    assert table["material.yield_stress"].tolist() == [30e6, 40e6]
    assert table.header["sweep"] == "sweep"
    plan = tomllib.loads((mg.scenario_folder() / "design" / "uniaxial.toml").read_text())
    of_file = mg.design(mg.scenario_folder() / "design" / "uniaxial.toml")
    plan["scenario"] = scenario
    assert str(mg.design(plan)).replace("design", "uniaxial") == str(of_file).replace("design", "uniaxial")


def test_the_level_of_a_calibration_can_be_chosen():
    file = mg.scenario_folder() / "calibrate" / "uniaxial.toml"
    wide, narrow = (mg.calibrate(file, confidence=level).parameters for level in (0.99, 0.5))
    for key, parameter in wide.items():
        assert parameter.value == narrow[key].value
        assert parameter.interval[0] < narrow[key].interval[0] < narrow[key].interval[1] < parameter.interval[1]
    with pytest.raises(ValueError, match="confidence"):
        mg.calibrate(file, confidence=1.0)


def test_expected_errors_are_those_of_the_program(run_program, tmp_path):
    file = mg.scenario_folder() / "design" / "uniaxial.toml"
    plan = mg.design(file, tmp_path / "ours")
    called = run_program("design", file, "-o", "theirs", cwd=tmp_path)
    assert called.returncode == 0
    assert str(plan) == called.stdout
    assert (tmp_path / "ours" / "errors.csv").read_bytes() == (tmp_path / "theirs" / "errors.csv").read_bytes()
    assert plan.values == {"material.youngs_modulus": 1e9, "material.yield_stress": 40e6}
    table = mg.Table.read_csv(tmp_path / "theirs" / "errors.csv")
    for name, errors in {"planned": plan.planned, **plan.candidates}.items():
        rows = table["with"] == name
        assert list(errors.standard_errors.values()) == table["standard_error"][rows].tolist()
        assert errors.covariance == pytest.approx(errors.covariance.T, rel=1e-12)
        assert_array_equal(np.diag(errors.correlation), [1.0, 1.0])
        assert np.sqrt(np.diag(errors.covariance)) == pytest.approx(table["standard_error"][rows], rel=1e-12)
        relative = errors.covariance / np.outer(list(plan.values.values()), list(plan.values.values()))
        assert errors.relative_variances == pytest.approx(np.trace(relative), rel=1e-12)
        assert errors.log_determinant == pytest.approx(np.log(np.linalg.det(relative)), rel=1e-9)
        assert errors.volume == pytest.approx(
            np.sqrt(np.linalg.det(errors.covariance) / np.linalg.det(plan.planned.covariance)), rel=1e-9
        )


def test_the_best_candidate_has_the_least_volume_and_the_least_variances():
    plan = mg.design(mg.scenario_folder() / "design" / "uniaxial.toml")
    assert set(plan.candidates) == {"unloading", "two_unloadings"}
    assert plan.best_by_volume == min(plan.candidates, key=lambda name: plan.candidates[name].volume)
    assert plan.best_by_variances == min(plan.candidates, key=lambda name: plan.candidates[name].relative_variances)
    assert plan.candidates[plan.best_by_volume].volume < plan.planned.volume == 1.0
    assert set(plan.notes) == {"loading", *plan.candidates}


def test_a_parameter_that_no_measurement_depends_on_is_not_determined(tmp_path):
    scenario = (mg.scenario_folder() / "uniaxial.toml").as_posix()
    file = tmp_path / "gentle.toml"
    file.write_text(
        f'scenario = "{scenario}"\n[free]\n"material.youngs_modulus" = {{ from = "0.1 GPa", to = "10 GPa" }}\n'
        '"material.yield_stress" = { from = "1 MPa", to = "200 MPa" }\n[[program]]\nname = "gentle"\n'
        "set = [\"loading.steps=[{ displacement = '0.001 R0', duration = '1 s' }]\"]\n"
        'noise = { absolute = "0.1 N" }\n'
    )
    plan = mg.design(file)
    assert plan.planned is None
    assert plan.candidates["gentle"].is_determined == {
        "material.youngs_modulus": True,
        "material.yield_stress": False,
    }
    assert plan.candidates["gentle"].relative_variances == np.inf
    assert plan.best_by_volume is None
    file.write_text(f'scenario = "{scenario}"\n[free]\n"material.yield_stress" = {{ from = 1e6, to = 2e8 }}\n')
    with pytest.raises(mg.ScenarioError, match="program"):
        mg.design(file)


def test_a_run_does_not_differ_from_itself_and_does_from_another(die, tmp_path):
    run, softer = die.run(), die.replace({"material.yield_stress": "49 MPa"}).run()
    same = mg.compare(run, run)
    assert same.gaps == []
    assert {curve.y for curve in same.curves} >= {"axial.force[N]", "event time[s]"}
    assert all(curve.linf == 0.0 and curve.coverage == 1.0 for curve in same.curves)
    assert "axial.force[N]" in same._repr_html_()
    (force,) = mg.compare(run, softer, x="axial.displacement", y="axial.force").curves
    assert 0.001 < force.linf < 0.1
    run.save(tmp_path / "a")
    softer.save(tmp_path / "b")
    assert mg.compare(tmp_path / "a", tmp_path / "b") == mg.compare(run, softer)
    (again,) = mg.compare(tmp_path / "a" / "history.csv", softer.history, x="axial.displacement", y="axial.force").curves
    assert again == force
    arrays = {name: softer.history[name[:-3]] for name in ("axial.displacement[m]", "axial.force[N]")}
    (of_arrays,) = mg.compare(run, arrays, x="axial.displacement", y="axial.force").curves
    assert of_arrays == force
    with pytest.raises(RuntimeError, match="did you mean 'axial.force'"):
        mg.compare(run, softer, y="axial.forse")
    with pytest.raises(TypeError, match="y: expected str, not"):
        mg.compare(run, softer, y=["axial.force"])


def test_models_are_those_of_the_program(run_program, tmp_path):
    listed = [line.split()[0] for line in run_program("models", cwd=tmp_path).stdout.splitlines()]
    models = mg.models()
    assert list(models) == listed
    mdr = models["mdr"]
    assert mdr.material["youngs_modulus"].unit == "Pa"
    assert mdr.material["youngs_modulus"].is_required
    assert mdr.material["poisson_ratio"].upper == 0.5
    assert "die" in mdr.configurations
    assert mdr.has_walls
    assert mdr.validity
    assert mdr.references[0].startswith("W. Zunker and K. Kamrin (2024), ")
    assert not models["packing"].has_walls
    assert "packing_fraction" in models["packing"].steps
    text = " ".join(run_program("models", "mdr", cwd=tmp_path).stdout.split())
    for key in (*mdr.material.values(), *mdr.options.values()):
        assert f"{key.name} " in text
        assert key.meaning in text


def test_parameters_are_those_of_the_program(run_program, tmp_path):
    for name in ("die", "semimech", "packing"):
        file = mg.scenario_folder() / f"{name}.toml"
        lines = run_program("models", "--parameters", file, cwd=tmp_path).stdout.splitlines()
        found = mg.parameters(mg.scenario(name))
        assert [line.split()[0] for line in lines] == list(found)
        assert [float(line.split()[1]) for line in lines] == [parameter.value for parameter in found.values()]


def test_the_schema_is_that_of_the_program(run_program, tmp_path):
    assert mg.schema() == json.loads(run_program("schema", cwd=tmp_path).stdout)


def test_an_unknown_ready_scenario_names_those_there_are():
    with pytest.raises(KeyError, match="did you mean 'die'"):
        mg.scenario("dye")


def test_the_version_is_that_of_the_program(run_program, tmp_path):
    assert run_program("--version", cwd=tmp_path).stdout.strip() == f"monograin {mg.__version__}"


@pytest.mark.parametrize("again", [copy.copy, lambda result: pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(result))))])
def test_a_calibration_and_a_design_can_be_pickled_and_copied(again):
    fit = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml")
    other = again(fit)
    assert other.parameters == fit.parameters
    assert (str(other), repr(other), other.notes, other.scenario_text) == (str(fit), repr(fit), fit.notes, fit.scenario_text)
    assert_array_equal(other.fit["residual"], fit.fit["residual"])
    assert other == fit and hash(other) == hash(fit)
    plan = mg.design(next((mg.scenario_folder() / "design").glob("*.toml")))
    assert str(again(plan)) == str(plan)
    assert again(plan) == plan and plan.planned == plan.planned
    assert plan.candidates["unloading"] != plan.planned
    assert again(plan).best_by_volume == plan.best_by_volume
    assert_array_equal(again(plan).table["standard_error"], plan.table["standard_error"])


def test_the_scenario_of_a_fit_runs_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scenario = mg.scenario("hollomon")
    run = scenario.run()
    loading = slice(0, int(np.argmax(run["axial.displacement"])) + 1)
    data = {name: run[name][loading] for name in ("axial.displacement[m]", "axial.force[N]")}
    fit = mg.calibrate(
        {
            "scenario": scenario,
            "data": {"file": data, "x": "axial.displacement[m]", "y": "axial.force[N]"},
            "free": {"material.yield_stress": {"from": 1e6, "to": 1e7}},
        }
    )
    value = mg.parameters(fit.scenario)["yield_stress"].value
    assert value == fit.values["material.yield_stress"] == pytest.approx(3.498409e6, rel=1e-6)
    force = fit.scenario.run()["axial.force"]
    assert_allclose(force[loading], run["axial.force"][loading], rtol=1e-5, atol=1e-6 * run["axial.force"].max())


def test_a_fit_is_drawn_through_its_data():
    pytest.importorskip("matplotlib")
    fit = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml")
    figure = fit.plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    (axes,) = figure.axes
    data, curve = axes.lines
    assert_array_equal(data.get_ydata(), fit.fit[fit.fit.columns[1]])
    assert_array_equal(curve.get_ydata(), fit.fit["fit"])
    assert axes.get_ylabel().endswith("[N]")
    assert fit.plot(axes=axes) is figure and len(axes.lines) == 4
    two = type(figure)().subplots(1, 2)
    fit.plot(axes=two)
    assert [len(each.lines) for each in two] == [2, 0]


def test_results_show_themselves_as_tables():
    fit = mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml")
    shown = fit._repr_html_()
    assert "material.yield_stress" in shown and f"{fit.values['material.yield_stress']:.5g}" in shown
    assert "yield_stress = 4.5" in repr(fit)
    plan = mg.design(next((mg.scenario_folder() / "design").glob("*.toml")))
    assert "standard_error" in plan._repr_html_()


def test_a_study_refuses_a_scenario_whose_files_are_in_memory(tmp_path):
    mg.scenario("hollomon").run().save(tmp_path)
    scenario = mg.Run.load(tmp_path).scenario
    with pytest.raises(ValueError, match="hollomon-pressure.csv in memory; expected files on disk"):
        mg.sweep({"scenario": scenario, "vary": {"output.points": {"values": [20, 30]}}}, tmp_path / "swept")
    (tmp_path / "hollomon-pressure.csv").write_text(scenario.files["hollomon-pressure.csv"])
    again = mg.Scenario(scenario.text, origin=tmp_path / "hollomon.toml", overrides=scenario.overrides)
    assert again == scenario
    assert len(mg.sweep({"scenario": again, "vary": {"output.points": {"values": [20, 30]}}}, tmp_path / "swept")) == 2


def test_wrong_types_of_studies_are_sentences(die, tmp_path):
    with pytest.raises(TypeError, match="threads: expected int, not 1.5"):
        mg.sweep({"scenario": die, "vary": {"output.points": {"values": [20, 30]}}}, tmp_path / "swept", threads=1.5)
    with pytest.raises(ValueError, match="shard = -1: expected 1 to the number of shards, 2"):
        mg.sweep({"scenario": die, "vary": {"output.points": {"values": [20, 30]}}}, tmp_path / "swept", shard=(-1, 2))
    for data in (np.zeros((3, 2)), [1.0, 2.0]):
        with pytest.raises(TypeError, match="data: expected a run, a table, a file, or arrays by name"):
            mg.calibrate(_uniaxial_fit(data))

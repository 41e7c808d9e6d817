"""Scenarios and runs."""

from __future__ import annotations

import copy
import gc
import json
import pathlib
import pickle
import re
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import monograin as mg

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = mg.scenarios()


def test_the_package_brings_every_ready_scenario():
    assert SCENARIOS == sorted(path.stem for path in (ROOT / "scenarios").glob("*.toml"))
    assert (mg.scenario_folder() / "calibrate" / "uniaxial.csv").is_file()


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_run_has_the_numbers_of_the_program_bit_by_bit(name, run_program, tmp_path):
    called = run_program("run", mg.scenario_folder() / f"{name}.toml", "-o", "out", "--quiet", cwd=tmp_path)
    expected = mg.Table.read_csv(tmp_path / "out" / "history.csv")
    run = mg.scenario(name).run()
    assert {0: "complete", 3: "stopped"}[called.returncode] == run.status
    assert run.columns == expected.columns
    assert run.units == expected.units
    for column in expected.columns:
        assert_array_equal(run[column], expected[column], err_msg=column)
    events = mg.Table.read_csv(tmp_path / "out" / "events.csv")
    assert run.events.columns == events.columns
    assert run.events.units == events.units
    assert len(run.events) == len(events)
    for column in events.columns:
        assert_array_equal(run.events[column], events[column], err_msg=column)


def test_saving_writes_the_files_of_the_program(run_program, die, tmp_path):
    run_program("run", mg.scenario_folder() / "die.toml", "-o", "theirs", "--quiet", cwd=tmp_path)
    run = mg.Scenario.load(mg.scenario_folder() / "die.toml").run()
    run.save(tmp_path / "ours")
    for name in ("history.csv", "events.csv"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    ours, theirs = (json.loads((tmp_path / side / "run.json").read_text()) for side in ("ours", "theirs"))
    assert ours.pop("timings_s").keys() == theirs.pop("timings_s").keys()
    assert ours == theirs


def test_info_is_what_run_json_holds(die, tmp_path):
    run = die.run()
    run.save(tmp_path)
    saved = json.loads((tmp_path / "run.json").read_text())
    # Only the file can tell how long its own writing took.
    assert saved["timings_s"].pop("output") > run.info["timings_s"]["output"] == 0.0
    assert {**run.info, "timings_s": saved["timings_s"]} == saved
    assert run.info["status"] == "complete"


def expect_the_same_run(again: mg.Run, run: mg.Run) -> None:
    for ours, theirs in ((again.history, run.history), (again.events, run.events)):
        assert (ours.columns, ours.units, ours.header) == (theirs.columns, theirs.units, theirs.header)
        for column in theirs.columns:
            assert_array_equal(ours[column], theirs[column], err_msg=column)
    assert again.info == run.info
    assert (again.status, again.message, again.limit) == (run.status, run.message, run.limit)
    assert again.warnings == run.warnings


@pytest.mark.parametrize("name", ["die", "free-centre", "packing", "compressible"])
def test_a_run_survives_pickling_and_copying(name, tmp_path):
    run = mg.scenario(name).run()
    for again in (pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        expect_the_same_run(again, run)
        assert again.scenario == run.scenario
    pickle.loads(pickle.dumps(run)).save(tmp_path / "again")
    expect_the_same_run(mg.Run.load(tmp_path / "again"), run)
    table = pickle.loads(pickle.dumps(run.history))
    assert_array_equal(table["time"], run["time"])


def test_a_run_of_the_program_is_loaded_and_repeated(run_program, tmp_path):
    softer = "material.yield_stress='30 MPa'"
    run_program("run", mg.scenario_folder() / "die.toml", "--set", softer, "-o", "out", "--quiet", cwd=tmp_path)
    run = mg.Run.load(tmp_path / "out")
    assert run.scenario.overrides == [softer]
    assert_array_equal(run.scenario.run()["axial.force"], run["axial.force"])
    assert len(run.profile(0.5)) > 100
    with pytest.raises(FileNotFoundError):
        mg.Run.load(tmp_path / "nothing")
    (tmp_path / "out" / "run.json").write_text("{}")
    with pytest.raises(ValueError, match="incomplete or damaged"):
        mg.Run.load(tmp_path / "out")


def test_saving_keeps_other_files_of_a_folder(die, tmp_path):
    (tmp_path / "letter.txt").write_text("mine")
    die.run().save(tmp_path)
    assert (tmp_path / "letter.txt").read_text() == "mine"
    assert mg.Run.load(tmp_path) == die.run()


@pytest.mark.parametrize("name", ["history.csv", "events.csv", "run.json"])
def test_saving_refuses_to_replace_a_file_of_the_user(name, die, tmp_path):
    (tmp_path / name).write_text("mine")
    with pytest.raises(RuntimeError, match=name):
        die.run().save(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"


def test_a_dict_is_the_scenario_of_its_text():
    made = mg.Scenario(
        {
            "model": "hertz",
            "particle": {"radius": 0.01},
            "material": {"youngs_modulus": "1 GPa", "poisson_ratio": 0.3},
            "loading": {
                "configuration": "simple",
                "steps": [{"displacement": "0.01 R0", "duration": 1.0}, {"displacement": 0.0, "duration": "1 s"}],
            },
        }
    )
    assert made.name == "scenario"
    run = made.run()
    modulus = mg.laws.hertz.composite_modulus(1e9, 0.3)
    expected = mg.laws.hertz.force(modulus, 0.01, run["axial.displacement"])
    np.testing.assert_allclose(run["axial.force"], expected, rtol=1e-14, atol=1e-12)


def test_replacing_is_editing_the_text(die):
    edited = die.text.replace('"50 MPa"', '"30 MPa"').replace('displacement = "0.4 R0"', "displacement = 0.0035")
    assert edited != die.text
    replaced = die.replace({"material.yield_stress": "30 MPa", "loading.steps[0].displacement": 0.0035})
    expected, run = mg.Scenario(edited).run(), replaced.run()
    for column in run.columns:
        assert_array_equal(run[column], expected[column], err_msg=column)
    assert die.overrides == []
    assert replaced.replace({"output.points": 10}).overrides[:2] == replaced.overrides


def test_replacing_again_keeps_the_order_and_does_not_pile_up():
    step = {"displacement": "0.1 R0", "duration": "1 s"}
    scenario = mg.scenario("hertz").replace({"loading.steps": [step]})
    for index in (1, 2, 1):
        scenario = scenario.replace({f"loading.steps[{index}]": step})
    for _ in range(3):
        scenario = scenario.replace({"material.youngs_modulus": 1e9, "material.poisson_ratio": 0.2})
    assert len(scenario.overrides) == 5


def test_every_kind_of_value_can_be_replaced():
    scenario = mg.scenario("die").replace(
        {
            "output": {"times": [0.5, 1.0]},
            "title": 'a "title" of two\nlines',
            "material.yield_stress": np.float64(4e7),
            "loading.centre": "fixed",
            "numerics.rtol": 1e-9,
        }
    )
    run = scenario.run()
    assert scenario.title == 'a "title" of two\nlines'
    assert {0.5, 1.0} <= set(run["time"])
    assert run.info["tolerances"]["rtol"] == 1e-9


def test_a_fault_tells_its_place_and_what_is_expected(die):
    text = die.text.replace("poisson_ratio  = 0.3", "poison_ratio = 0.3").replace('"50 MPa"', '"50 MPA"')
    with pytest.raises(mg.ScenarioError) as caught:
        mg.Scenario(text, origin="soft.toml")
    faults = caught.value.faults
    lines = text.splitlines()
    assert len(faults) >= 2
    by_line = {fault.line: fault for fault in faults}
    misspelt = next(i for i, line in enumerate(lines, 1) if line.startswith("poison_ratio"))
    unit = next(i for i, line in enumerate(lines, 1) if "50 MPA" in line)
    assert (by_line[misspelt].file, by_line[misspelt].column) == ("soft.toml", 1)
    assert "poisson_ratio" in by_line[misspelt].text
    assert by_line[unit].column == lines[unit - 1].index('"') + 1
    assert str(caught.value).splitlines() == [str(fault) for fault in faults]


def test_a_fault_of_a_replaced_value_names_the_replacement(die):
    with pytest.raises(mg.ScenarioError) as caught:
        die.replace({"material.yield_stress": "30 metres"})
    (fault,) = caught.value.faults
    assert fault.file == "override 'material.yield_stress=\"30 metres\"'"


def test_a_missing_file_is_a_fault(tmp_path):
    with pytest.raises(mg.ScenarioError) as caught:
        mg.Scenario.load(tmp_path / "none.toml")
    assert "no such file" in str(caught.value)


def test_an_error_survives_pickling(die):
    with pytest.raises(mg.ScenarioError) as caught:
        die.replace({"material.poisson_ratio": 0.9})
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.faults == caught.value.faults
    assert str(again) == str(caught.value)


def test_a_limit_of_the_model_stops_a_run_and_raises_nothing():
    run = mg.scenario("die").replace({"loading.steps[0].displacement": "0.6 R0"}).run()
    assert run.status == "stopped"
    assert run.limit == run.info["limit"] == "free-surface-used-up"
    assert "free surface" in run.message
    assert run["axial.displacement"][-1] < 0.006
    assert len(run) > 2


class FailedCore:
    """A recorded run whose solver gave up, which no ready scenario's does."""

    status, message = "failed", "the solver gave up"

    def __init__(self, core):
        self.history, self.events = core.history, core.events

    def run(self):
        return self


def test_a_solver_that_gives_up_raises_with_its_run(die):
    run = die.run()
    assert run.scenario is die
    failing = mg.Scenario.__new__(mg.Scenario)
    failing._core = FailedCore(run._core)
    assert failing.run(check=False).status == "failed"
    with pytest.raises(mg.SolverError, match="the solver gave up") as caught:
        failing.run()
    assert caught.value.run.status == "failed"
    assert len(caught.value.run) == len(run)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.run) == (str(caught.value), None)


def test_a_misspelt_column_is_a_key_error_with_the_near_one(die):
    run = die.run()
    with pytest.raises(KeyError, match="did you mean 'axial.force'"):
        run["axial.forse"]
    assert "axial.force" in run
    assert "axial.forse" not in run
    assert_array_equal(run["axial.force[N]"], run["axial.force"])


def test_columns_are_views_that_keep_their_memory(die):
    run = die.run()
    first, again = run["axial.force"], run["axial.force"]
    assert not first.flags.writeable
    assert not first.flags.owndata
    assert np.shares_memory(first, again)
    with pytest.raises(ValueError):
        first[0] = 1.0
    copy = first.copy()
    del run, again
    gc.collect()
    others = [die.run()["axial.force"].sum() for _ in range(5)]
    assert len(set(others)) == 1
    assert_array_equal(first, copy)


def test_words_are_arrays_of_str(die):
    regimes = die.run()["axial.regime"]
    assert regimes.dtype.kind == "U"
    assert {"elastic", "plastic-loading"} & set(regimes)


def test_events_are_rows(die):
    events = die.run().events
    names = [event["event"] for event in events]
    assert len(names) == len(events) > 3
    assert names == list(events["event"])
    assert all(isinstance(event["time"], float) for event in events)


def test_a_scenario_survives_pickling_and_finds_its_files(monkeypatch, tmp_path):
    scenario = mg.scenario("hollomon").replace({"output.points": 20})
    monkeypatch.chdir(tmp_path)
    again = pickle.loads(pickle.dumps(scenario))
    assert again == scenario
    assert hash(again) == hash(scenario)
    assert again != mg.scenario("hollomon")
    assert_array_equal(again.run()["axial.force"], scenario.run()["axial.force"])


def test_to_pandas_has_every_column(die):
    pandas = pytest.importorskip("pandas")
    run = die.run()
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == run.columns
    assert_array_equal(frame["axial.force"], run["axial.force"])
    frame.loc[0, "axial.force"] = 7.0
    assert run["axial.force"][0] != 7.0


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_ready_scenario_can_be_plotted(name, tmp_path):
    pytest.importorskip("matplotlib")
    run = mg.scenario(name).run()
    figure = run.plot()
    axes = figure.axes
    assert 1 <= len(axes) <= 4
    for panel in axes:
        assert any(np.isfinite(line.get_ydata()).any() for line in panel.lines)
        assert panel.get_xlabel()
        assert panel.get_ylabel()
    if name == "die":
        assert {line.get_linestyle() for line in axes[0].lines} >= {"-", "--", ":"}
        figure.savefig(tmp_path / "die.png")
        assert (tmp_path / "die.png").stat().st_size > 10_000


def test_a_profile_carries_the_force_of_its_instant(die):
    run = die.run()
    profile = run.profile(0.5)
    assert profile.units == {"class": "", "radius": "m", "pressure": "Pa", "displacement": "m", "relaxed_height": "m"}
    axial = profile["class"] == "axial"
    radius, pressure = profile["radius"][axial], profile["pressure"][axial]
    force = 2.0 * np.pi * np.trapz(pressure * radius, radius)
    row = np.flatnonzero(run["time"] == 0.5)[0]
    # A trapezoidal sum over a pressure that is steep at the edge.
    assert force == pytest.approx(run["axial.force"][row], rel=0.02)


def test_a_profile_beyond_the_run_is_an_error(die):
    with pytest.raises(RuntimeError, match="no profile"):
        die.run().profile(99.0)
    with pytest.raises(RuntimeError, match="expected a finite instant, 0 or later"):
        die.run().profile(float("inf"))
    with pytest.raises(RuntimeError, match="has no profile"):
        mg.scenario("packing").run().profile(0.5)


def test_a_scenario_stays_the_same_in_another_working_directory(tmp_path, monkeypatch):
    text = mg.scenario("hollomon").text
    source = mg.scenario_folder() / "hollomon-pressure.csv"
    for folder, factor in (("a", 1.0), ("b", 2.0)):
        (tmp_path / folder).mkdir()
        table = mg.Table.read_csv(source)
        x, pressure = (table[name] for name in table.columns)
        lines = [f"{at!r},{factor * value!r}\n" for at, value in zip(x.tolist(), pressure.tolist())]
        headings = ",".join(f"{name}[{unit}]" for name, unit in table.units.items())
        (tmp_path / folder / source.name).write_text(headings + "\n" + "".join(lines))
    monkeypatch.chdir(tmp_path / "a")
    scenario = mg.Scenario(text)
    largest, name = scenario.run()["axial.force"].max(), hash(scenario)
    monkeypatch.chdir(tmp_path / "b")
    assert mg.Scenario(text).run()["axial.force"].max() != largest
    assert hash(scenario) == name
    changed = scenario.replace({"title": "again"})
    for other in (copy.copy(scenario), changed, pickle.loads(pickle.dumps(scenario)), mg.Scenario(changed.to_toml())):
        assert other.run()["axial.force"].max() == largest
    radius = mg.parameters(scenario)["radius"].value
    assert scenario.prepare(["particle.radius"]).run([radius])["axial.force"].max() == largest


def test_overrides_of_one_key_do_not_pile_up():
    scenario = mg.scenario("die")
    for value in (40e6, 50e6, 60e6):
        scenario = scenario.replace({"material.yield_stress": value}).replace({"material.youngs_modulus": 20.0 * value})
    assert scenario.overrides == ["material.yield_stress=60000000.0", "material.youngs_modulus=1200000000.0"]
    for duration in (1.0, 2.0, 3.0):
        scenario = scenario.replace({f"loading.steps[{k}].duration": duration for k in range(2)})
    assert len(scenario.overrides) == 4
    # A table takes the place of its keys, so that the order counts.
    steps = [{"displacement": "0.1 R0", "duration": 1.0}]
    scenario = mg.scenario("die").replace({"loading.steps[0].duration": 2.0}).replace({"loading.steps": steps})
    assert scenario.replace({"loading.steps[0].duration": 3.0}).run()["time"][-1] == 3.0


def test_a_changed_scenario_can_be_written_and_read_again():
    changed = mg.scenario("die").replace({"material.yield_stress": "30 MPa"})
    expected = changed.run()["axial.force"]
    assert "30 MPa" in changed.to_toml()
    assert_array_equal(mg.Scenario(changed.to_toml()).run()["axial.force"], expected)
    assert_array_equal(mg.Scenario(changed.to_dict()).run()["axial.force"], expected)


def test_the_name_of_a_file_is_no_text_of_a_scenario(tmp_path):
    for name in (tmp_path / "a.toml", "a.toml"):
        with pytest.raises(TypeError, match="Scenario.load"):
            mg.Scenario(name)
    assert mg.Scenario(mg.scenario("die").text + "\n# from die.toml").model == "mdr"
    with pytest.raises(TypeError, match="overrides"):
        mg.Scenario(mg.scenario("die").text, overrides="title='x'")


def test_nothing_that_a_run_hands_out_changes_it(tmp_path):
    run = mg.scenario("die").run()
    with pytest.raises(ValueError):
        run["axial.regime"][0] = "changed"
    run.save(tmp_path / "saved")
    loaded = mg.Run.load(tmp_path / "saved")
    for each in (run, loaded):
        count = len(each.warnings)
        each.warnings.append("changed")
        assert len(each.warnings) == count


def test_a_run_is_a_mapping_of_columns_and_yields_rows():
    run = mg.scenario("hertz").run()
    assert list(dict(run)) == run.columns
    rows = list(run)
    assert len(rows) == len(run)
    assert rows[-1]["axial.force"] == run["axial.force"][-1]
    assert run.to_pandas().attrs["units"] == run.units


def test_a_copied_or_pickled_run_is_the_same_run(tmp_path):
    run = mg.scenario("compressible").run()
    run.save(tmp_path / "saved")
    for origin in (run, mg.Run.load(tmp_path / "saved")):
        for again in (copy.copy(origin), pickle.loads(pickle.dumps(origin))):
            assert again.status == run.status and again.info["status"] == run.status
            assert again.units == run.units and again.history.header == run.history.header
            for column in run.columns:
                assert_array_equal(again[column], run[column], err_msg=column)
            assert again.events["event"].tolist() == run.events["event"].tolist()
            again.save(tmp_path / "again")
            for file in ("history.csv", "events.csv"):
                assert (tmp_path / "again" / file).read_bytes() == (tmp_path / "saved" / file).read_bytes()


MANY_ROWS = {"output.points": 1_000_000}
SENSITIVE = {"output.points": 100_000, "sensitivities.keys": ["material.yield_stress", "particle.radius"]}


@pytest.mark.parametrize("values", [MANY_ROWS, SENSITIVE])
def test_ctrl_c_ends_a_run(values, tmp_path):
    code = f"""
        import os, signal, threading, time
        import monograin as mg

        scenario = mg.scenario("cycles").replace({values})
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        start = time.process_time()
        try:
            scenario.run()
        except KeyboardInterrupt:
            print(time.process_time() - start)
        """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 2.5


def test_an_empty_cell_among_numbers_is_nan_and_units_tell_columns_apart(tmp_path):
    (tmp_path / "table.csv").write_text("a[m],a[mm],word\n1,,x\n3,4,\n")
    table = mg.Table.read_csv(tmp_path / "table.csv")
    assert table.columns == ["a[m]", "a[mm]", "word"]
    assert table.units == {"a[m]": "m", "a[mm]": "mm", "word": ""}
    assert table.to_pandas()["a[mm]"][1] == 4.0
    assert table["a[m]"].tolist() == [1.0, 3.0]
    assert np.isnan(table["a[mm]"][0]) and table["a[mm]"][1] == 4.0
    assert table["word"].tolist() == ["x", ""]
    with pytest.raises(FileNotFoundError):
        mg.Table.read_csv(tmp_path / "none.csv")


def test_a_table_of_arrays_has_their_values_units_and_words():
    table = mg.Table.from_columns(
        {"x[mm]": [0.0, 1.0, np.nan], "force": np.arange(3), "regime": ["open", "elastic", "open"]}, {"force": "N"}
    )
    assert table.columns == ["x", "force", "regime"]
    assert table.units == {"x": "mm", "force": "N", "regime": ""}
    np.testing.assert_array_equal(table["x"], [0.0, 1.0, np.nan])
    assert table["force"].tolist() == [0.0, 1.0, 2.0]
    assert table["regime"].tolist() == ["open", "elastic", "open"]


def test_a_table_goes_to_pandas_and_back(die):
    pytest.importorskip("pandas")
    history = die.run().history
    back = mg.Table.from_columns(history.to_pandas())
    assert back.columns == history.columns and back.units == history.units
    for name in history.columns:
        np.testing.assert_array_equal(back[name], history[name])


@pytest.mark.parametrize("columns", [{}, {"a": [1.0], "b": [1.0, 2.0]}, {"a": [[1.0]]}, {"a": 1.0}])
def test_a_table_of_unequal_arrays_is_refused(columns):
    with pytest.raises(ValueError, match="expected columns of equal length"):
        mg.Table.from_columns(columns)


def test_a_figure_shows_itself_in_a_notebook(die):
    pytest.importorskip("matplotlib")
    figure = die.run().plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert pickle.loads(pickle.dumps(figure))._repr_png_().startswith(b"\x89PNG")


def test_columns_of_choice_are_drawn_in_si_units(die):
    pytest.importorskip("matplotlib")
    run = die.run()
    (axes,) = run.plot("axial.force").axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("axial.displacement [m]", "axial.force [N]")
    drawn = np.concatenate([line.get_ydata() for line in axes.lines if line.get_linestyle() != "None"])
    assert np.nanmax(drawn) == np.nanmax(run["axial.force"])
    first, second = run.plot(["axial.force[N]", "apparent_radius"], x="time").axes
    assert (first.get_xlabel(), second.get_ylabel()) == ("time [s]", "apparent_radius [m]")
    assert len(run.plot(x="time").axes) == 4
    with pytest.raises(ValueError, match="'axial.regime' holds words"):
        run.plot("axial.regime")
    with pytest.raises(KeyError, match="axial.force"):
        run.plot("axial.forse")


def test_runs_share_the_axes_of_a_figure_and_differ_in_colour(die):
    pytest.importorskip("matplotlib")
    figure = die.run().plot("axial.force", label="hard")
    softer = die.replace({"material.yield_stress": "30 MPa"}).run()
    assert softer.plot("axial.force", label="soft", axes=figure.axes) is figure
    (axes,) = figure.axes
    colours = {line.get_label(): line.get_color() for line in axes.lines}
    assert colours["hard"] != colours["soft"]
    assert axes.get_legend() is None
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert len(texts) == len(set(texts)) and {"hard", "soft", "yield"} <= set(texts)
    with pytest.raises(ValueError, match="1 for 2 panels"):
        softer.plot(["axial.force", "axial.pressure"], axes=axes)


def test_a_colour_stands_for_one_curve_in_all_panels(die):
    pytest.importorskip("matplotlib")
    figure = die.run().plot(label="hard")
    die.replace({"material.yield_stress": "30 MPa"}).run().plot(label="soft", axes=figure.axes)
    names: dict[str, set[str]] = {}
    for axes in figure.axes:
        for line in axes.lines:
            if not line.get_label().startswith("_") and line.get_linestyle() != "None":
                names.setdefault(line.get_color(), set()).add(line.get_label())
    assert sorted(map(sorted, names.values())) == [
        ["hard"],
        ["hard: axial"],
        ["hard: lateral"],
        ["soft"],
        ["soft: axial"],
        ["soft: lateral"],
    ]


def test_an_event_has_one_mark_in_all_panels_of_a_figure(die):
    pytest.importorskip("matplotlib")
    figure = die.run().plot()
    die.replace({"material.yield_stress": "30 MPa"}).run().plot(axes=figure.axes)
    marks: dict[str, set[tuple[str, str, str]]] = {}
    for axes in figure.axes:
        for line in axes.lines:
            if line.get_linestyle() == "None":
                look = (line.get_marker(), line.get_markerfacecolor(), line.get_color())
                marks.setdefault(line.get_label(), set()).add(look)
    assert len(marks) > 5
    assert all(len(found) == 1 for found in marks.values())
    looks = [look for found in marks.values() for look in found]
    assert len(set(looks)) == len(looks)
    assert marks["load-reversal"] == {("s", "none", "#000000")}
    assert marks["growth-on"] == {("o", "#000000", "#000000")}


def test_symbols_of_events_are_those_of_the_program_s_figures():
    figure = pytest.importorskip("monograin._figure")
    source = (ROOT / "src" / "figure" / "legend.cpp").read_text()
    names = re.search(r"k_events\{(.*?)\};", source, re.DOTALL)[1]
    assert tuple(re.findall(r'"([^"]+)"', names)) == figure._EVENTS
    colours = re.search(r"k_event_colours\{(.*?)\};", source)[1]
    assert tuple("#" + colour for colour in re.findall(r"0x(\w+)u", colours)) == figure._EVENT_COLOURS
    points = re.search(r"k_points\{(.*?)\};", source)[1].split(", ")
    # gnuplot's numbers of the symbols of matplotlib: open ones and crosses, then filled ones.
    numbers = {"o": 6, "s": 4, "^": 8, "v": 10, "D": 12, "p": 14, "x": 2, "+": 1, "$*$": 3}
    drawn = [numbers[symbol] for symbol in figure._OPEN_SYMBOLS]
    assert list(map(int, points)) == drawn + [numbers[symbol] + 1 for symbol in figure._FILLED_SYMBOLS]


def test_events_of_contacts_are_not_drawn_on_curves_of_the_particle(die):
    pytest.importorskip("matplotlib")
    (axes,) = die.run().plot("apparent_radius").axes
    assert {line.get_label() for line in axes.lines if line.get_linestyle() == "None"} == {"growth-on", "growth-off"}
    (axes,) = mg.scenario("packing").run().plot("stress").axes
    assert "jamming" in {line.get_label() for line in axes.lines}


def test_the_legend_of_a_figure_stands_below_all_panels(die):
    pytest.importorskip("matplotlib")
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = die.run().plot(label="hard")
    height = figure.get_figheight()
    die.replace({"material.yield_stress": "30 MPa"}).run().plot(axes=figure.axes, label="soft")
    assert figure.get_figheight() > height
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    (legend,) = figure.legends
    box = legend.get_window_extent(canvas.get_renderer())
    assert box.y1 <= min(axes.get_tightbbox(canvas.get_renderer()).y0 for axes in figure.axes)
    assert 0.0 <= box.x0 and box.x1 <= figure.bbox.width and 0.0 <= box.y0
    assert all(axes.get_legend() is None for axes in figure.axes)


def test_axes_of_a_figure_of_the_caller_have_their_legend_in_the_first_panel(die):
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    figure = Figure()
    assert die.run().plot(axes=figure.subplots(2, 2)) is figure
    legends = [axes.get_legend() for axes in figure.axes]
    assert legends[0] and not any(legends[1:]) and not figure.legends


def test_a_column_that_events_lack_is_drawn_without_them(die):
    pytest.importorskip("matplotlib")
    run = die.run()
    assert "row" in run and "row" not in run.events
    for figure in (run.plot("row"), run.plot("axial.force", x="row")):
        (axes,) = figure.axes
        assert axes.lines and all(line.get_linestyle() != "None" for line in axes.lines)


def test_a_file_that_the_scenario_does_not_name_is_refused():
    hollomon = mg.scenario("hollomon")
    name = "hollomon-pressure.csv"
    content = (mg.scenario_folder() / name).read_text()
    assert mg.Scenario(hollomon.text, files={name: content}).replace({"output.points": 20}).files == {name: content}
    with pytest.raises(ValueError, match="files: the scenario names no file 'hollomon-presure.csv'"):
        mg.Scenario(hollomon.text, files={"hollomon-presure.csv": content})


def test_runs_and_tables_show_their_first_and_last_rows(die):
    run = die.run()
    shown = run._repr_html_()
    assert "Run complete" in shown and "axial.force [N]" in shown and "more columns" in shown
    assert shown.count("<tr>") == 12  # headings, five rows, a gap, five rows
    short = mg.Table.from_columns({"<a>[m]": [1.0], "word": ["x"]})._repr_html_()
    assert "&lt;a&gt; [m]" in short and "<td>x</td>" in short and short.count("<tr>") == 2


def test_a_loaded_run_keeps_the_files_of_its_scenario(tmp_path, monkeypatch):
    run = mg.scenario("hollomon").run()
    run.save(tmp_path / "saved")
    monkeypatch.chdir(tmp_path)
    for again in (mg.Run.load("saved"), pickle.loads(pickle.dumps(mg.Run.load("saved")))):
        assert again == run
        assert len(again.profile(0.5)) == len(run.profile(0.5))
        scenario = again.scenario.replace({"output.points": 20})
        expected = run.scenario.replace({"output.points": 20}).run()["axial.force"]
        assert_array_equal(scenario.run()["axial.force"], expected)
        assert_array_equal(scenario.prepare(["material.yield_stress"]).map([3.498409e6], ["end(axial.force)"]), [[expected[-1]]])


def test_equality_is_that_of_contents(die, tmp_path):
    run = die.run()
    for again in (copy.copy(run), die.run(), pickle.loads(pickle.dumps(run))):
        assert again == run and hash(again) == hash(run)
        assert again.history == run.history
    assert run != die.replace({"material.yield_stress": "49 MPa"}).run()
    assert run.history != run.events
    assert mg.Scenario(die.text) == die == mg.Scenario(die.to_dict())
    assert hash(mg.Scenario(die.to_dict())) == hash(die)
    assert die.replace({"material.yield_stress": "49 MPa"}) != die
    changed = mg.Scenario(die.text.replace('"50 MPa"', '"49 MPa"'))
    assert die.replace({"material.yield_stress": "49 MPa"}) == changed
    hollomon = mg.scenario("hollomon")
    assert mg.Scenario(hollomon.to_dict()) == hollomon
    name = "hollomon-pressure.csv"
    other = mg.Scenario(hollomon.text, files={name: "delta_max_over_R,p_over_Y\n0,3.6\n0.1,5\n0.3,6\n0.6,6\n"})
    assert other != hollomon


def test_comments_and_the_name_of_a_scenario_do_not_make_runs_differ(die):
    run = die.run()
    again = mg.Scenario("# A comment.\n" + die.text, origin="elsewhere/other.toml").run()
    assert again.history.header["scenario"] == "other"
    assert again == run and hash(again) == hash(run)
    assert mg.Scenario(die.text + '\n[numerics]\nrtol = 1e-9\n').run() != run


def test_tables_that_steps_follow_belong_to_a_scenario(tmp_path):
    step = {"displacement": {"table": "path.csv", "time": "t[s]", "value": "x[mm]"}}
    content = mg.scenario("hertz").to_dict()
    content["loading"]["steps"] = [step]
    scenarios = []
    for folder, target in (("a", 0.1), ("b", 0.2)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "path.csv").write_text(f"t[s],x[mm]\n0,0\n1,{target}\n")
        scenarios.append(mg.Scenario(content, origin=tmp_path / folder / "path.toml"))
    first, second = scenarios
    assert first != second and hash(first) != hash(second)
    (placed,) = first.to_dict()["loading"]["steps"]
    assert placed["displacement"]["table"] == str(tmp_path / "a" / "path.csv")
    again = mg.Scenario(first.to_toml())
    assert again == first == mg.Scenario(content, files={"path.csv": (tmp_path / "a" / "path.csv").read_text()})
    assert_array_equal(again.run()["axial.force"], first.run()["axial.force"])


@pytest.mark.parametrize("wrong", [0, -1, None, slice(0, 3), ["time"]])
def test_only_a_name_finds_a_column(die, wrong):
    with pytest.raises(TypeError, match="column: expected str, not"):
        die.run()[wrong]


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda: mg.Scenario(None), r"source: expected str or Mapping\[str, Any\], not None"),
        (lambda: mg.Scenario(mg.scenario("die")), "source: expected str"),
        (lambda: mg.Scenario([1]), "source: expected str"),
        (lambda: mg.scenario("die").replace(None), r"values: expected Mapping\[str, Any\], not None"),
        (lambda: mg.scenario("die").replace([("a", 1)]), "values: expected Mapping"),
        (lambda: mg.Scenario.load(3), "path: expected str or PathLike"),
        (lambda: mg.parameters("die"), "scenario: expected Scenario, not 'die'"),
        (lambda: mg.Prepared("die", ["material.yield_stress"]), "scenario: expected Scenario, not 'die'"),
        (lambda: mg.Run.load(None), "folder: expected str"),
        (lambda: mg.scenario("die").run().profile("x"), "time: expected float, not 'x'"),
        (lambda: mg.scenario("die").run().plot(axes=3), "axes: expected axes of matplotlib, not 3"),
        (lambda: mg.Table.from_columns([1, 2]), "columns: expected arrays by name"),
        (lambda: mg.Scenario(mg.scenario("die").text, files=3), "files: expected texts by name, in a dict, not 3"),
        (lambda: mg.Scenario(mg.scenario("die").text, files={"a.csv": 3}), "files: expected texts by name, not 3 by 'a.csv'"),
        (lambda: mg.scenario("die").run().profile(np.array([0.1, 0.2])), "time: expected float, not array"),
        (lambda: mg.Table.from_columns({"a": [1.0]}, units="N"), "units: expected texts by name, in a dict, not 'N'"),
        (lambda: mg.compare(3, mg.scenario("die").run()), "a: expected a run, a table, a file, or arrays by name, not 3"),
        (lambda: mg.compare(mg.scenario("die").run(), 3), "b: expected a run, a table, a file, or arrays by name, not 3"),
        (lambda: mg.Scenario("die"), "no TOML text; Scenario.load reads files, and monograin.scenario has ready"),
    ],
)
def test_a_wrong_type_is_a_sentence_with_the_argument(call, sentence):
    with pytest.raises(TypeError, match=sentence):
        call()


def test_names_that_are_unknown_bring_near_ones(die):
    for mapping, name, near in (
        (die.run(), "force", "axial.force"),
        (die.run().units, "axial.forc", "axial.force"),
        (mg.models(), "mrd", "mdr"),
        (mg.models()["mdr"].material, "yeld_stress", "yield_stress"),
        (mg.parameters(die), "yield_stres", "yield_stress"),
    ):
        with pytest.raises(KeyError, match=f"there is no '{name}'; did you mean .*'{near}'"):
            mapping[name]
    assert len(repr(mg.models())) < 4000


def test_a_folder_without_a_name_is_refused(die):
    with pytest.raises(ValueError, match="folder: expected a name"):
        die.run().save("")


def test_rows_of_a_long_table_come_one_after_the_other():
    table = mg.Table.from_columns({"x": np.arange(3000.0), "word": ["a", "b", "c"] * 1000})
    rows = list(table)
    assert [row["x"] for row in rows] == list(range(3000))
    assert rows[2999]["word"] == "c"
    assert next(iter(table)) == {"x": 0.0, "word": "a"}


def test_masked_and_missing_elements_of_a_table_are_nan():
    pandas = pytest.importorskip("pandas")
    table = mg.Table.from_columns(
        {
            "masked": np.ma.array([1, 2], mask=[False, True]),
            "none": [1.0, None],
            "pandas": pandas.array([1, None], dtype="Int64"),
            "word": ["x", None],
        }
    )
    for name in ("masked", "none", "pandas"):
        assert_array_equal(table[name], [1.0, np.nan], err_msg=name)
    assert table["word"].tolist() == ["x", ""]


@pytest.mark.parametrize(
    "column, values",
    [
        (["1", "nan"], [1.0, np.nan]),
        ([1.0, "nan"], [1.0, np.nan]),
        (["nan"], [np.nan]),
        (np.ma.array(["1", "x"], mask=[False, True]), [1.0, np.nan]),
        ([None, "2"], [np.nan, 2.0]),
        (["nan", "a"], ["nan", "a"]),
        ([np.nan, "a"], ["", "a"]),
        ([None, "a"], ["", "a"]),
        (np.ma.array(["a", "7"], mask=[False, True]), ["a", ""]),
        (np.ma.array(["a"], mask=[True]), [""]),
    ],
)
def test_texts_are_read_as_numbers_if_there_is_one_that_is_not_missing(column, values):
    found = mg.Table.from_columns({"a": column})["a"]
    assert_array_equal(found, values)
    assert found.dtype.kind == np.asarray(values).dtype.kind


def test_no_texts_are_a_column_of_words_and_no_numbers_one_of_numbers():
    table = mg.Table.from_columns({"word": np.array([], dtype=str), "number": []})
    assert (table["word"].dtype.kind, table["number"].dtype.kind) == ("U", "f")
    assert len(table) == 0


@pytest.mark.parametrize(
    "columns, units, error, sentence",
    [
        ({"a[N]": [1.0], "a": [2.0]}, {"a": "N"}, ValueError, "two columns 'a' of one unit"),
        ({"force": [1.0]}, {"forse": "N"}, ValueError, "did you mean 'force'"),
        ({"a[N]": [1.0]}, {"a[N]": "kN"}, ValueError, r"units: 'kN' for 'a\[N\]', whose heading has 'N'"),
        ({"a": [1j, "x"]}, None, ValueError, "column 'a' holds texts and 1j"),
        ({"a": [1.0, "x"]}, None, ValueError, "column 'a' holds numbers and 'x'"),
        ({"a": np.array(["2020"], dtype="M8")}, None, TypeError, "column 'a': expected real numbers, not dates"),
        ({"a": [1j]}, None, TypeError, "complex"),
    ],
)
def test_columns_that_cannot_be_are_refused(columns, units, error, sentence):
    with pytest.raises(error, match=sentence):
        mg.Table.from_columns(columns, units)


def test_a_run_takes_no_new_attributes(die):
    with pytest.raises(AttributeError):
        die.run().notamember = 1

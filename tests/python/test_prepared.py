"""Prepared scenarios, threads and interrupts."""

from __future__ import annotations

import concurrent.futures
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import monograin as mg

KEYS = ["material.youngs_modulus", "material.yield_stress", "loading.steps[0].displacement"]
COLUMNS = ["max(axial.force)", "end(apparent_radius)", "last(axial.pressure) / max(axial.force)"]


@pytest.fixture(scope="module")
def prepared() -> mg.Prepared:
    return mg.scenario("die").prepare(KEYS)


@pytest.fixture(scope="module")
def samples() -> np.ndarray:
    draw = np.random.default_rng(1)
    return np.column_stack([draw.uniform(0.8e9, 2e9, 24), draw.uniform(3e7, 8e7, 24), draw.uniform(3.3e-3, 4.1e-3, 24)])


def test_a_prepared_run_is_that_of_the_edited_text_bit_by_bit(prepared, samples):
    for values in samples[:6]:
        run = prepared.run(values)
        text = mg.scenario("die").text
        for old, new in zip(('"1 GPa"', '"50 MPa"', '"0.4 R0"'), values):
            assert old in text
            text = text.replace(old, repr(float(new)), 1)
        expected = mg.Scenario(text).run()
        assert run.columns == expected.columns
        for column in run.columns:
            assert_array_equal(run[column], expected[column], err_msg=column)


def test_map_gives_the_numbers_of_single_runs(prepared, samples):
    table, statuses = prepared.map(samples, COLUMNS, statuses=True)
    assert table.shape == (len(samples), len(COLUMNS))
    for values, row, status in zip(samples, table, statuses):
        run = prepared.run(values)
        assert status == run.status
        force, pressure = run["axial.force"], run["axial.pressure"]
        expected = [np.nanmax(force), run["apparent_radius"][-1], pressure[~np.isnan(pressure)][-1] / np.nanmax(force)]
        assert_allclose(row, expected, rtol=1e-13)


def test_map_does_not_depend_on_threads(prepared, samples):
    one, four = (prepared.map(samples, COLUMNS, threads=threads) for threads in (1, 4))
    assert_array_equal(one, four)


def test_rows_that_are_refused_are_nan(prepared, samples):
    some = samples[:3].copy()
    some[1, 1] = -5.0
    table, statuses = prepared.map(some, COLUMNS, statuses=True)
    assert list(statuses) == ["complete", "refused", "complete"]
    assert np.isnan(table[1]).all()
    assert np.isfinite(table[[0, 2]]).all()
    with pytest.raises(mg.ScenarioError):
        prepared.run(some[1])


def test_a_key_that_is_none_is_a_fault():
    with pytest.raises(mg.ScenarioError, match="yield_stress"):
        mg.scenario("die").prepare(["material.yield_stres"])
    with pytest.raises(mg.ScenarioError, match="takes no number"):
        mg.scenario("die").prepare(["loading.configuration"])


def test_a_formula_that_is_none_is_an_error(prepared, samples):
    with pytest.raises(ValueError, match="axial.forse"):
        prepared.map(samples, ["max(axial.forse)"])
    with pytest.raises(ValueError, match="expected an operator"):
        prepared.map(samples, ["max(axial.force) max"])
    with pytest.raises(ValueError, match="a value for each row"):
        prepared.map(samples, ["axial.force"])
    with pytest.raises(ValueError, match="list of formulas"):
        prepared.map(samples, "max(axial.force)")
    with pytest.raises(ValueError, match="'axial.regime' holds words"):
        prepared.map(samples, ["end(axial.regime)"])


def test_a_formula_takes_the_heading_of_a_column(prepared, samples):
    force, same = prepared.map(samples[:2], ["max(axial.force)", "max(axial.force[N])"]).T
    assert_array_equal(force, same)
    with pytest.raises(ValueError, match=r"there is no 'axial.force\[kN\]'; expected axial.force\[N\]"):
        prepared.map(samples[:2], ["max(axial.force[kN])"])


def test_a_formula_takes_the_derivative_by_a_key_in_a_list():
    key = "loading.steps[0].displacement"
    scenario = mg.scenario("uniaxial").replace({"sensitivities": {"keys": [key]}})
    name = f"`d(axial.force)/d({key})`"
    values = scenario.prepare(["material.poisson_ratio"]).map([0.3], [f"end({name})"])
    assert np.isfinite(values).all()


def test_samples_that_are_masked_are_refused_and_others_than_numbers_are_errors():
    single = mg.scenario("die").prepare(["material.yield_stress"])
    table, statuses = single.map(np.ma.array([4e7, 5e7], mask=[0, 1]), COLUMNS[:1], statuses=True)
    assert statuses.tolist() == ["complete", "refused"]
    assert np.isnan(table[1, 0])
    for wrong in ("40 MPa", ["40 MPa"], [1j], np.array(["2020"], dtype="M8"), None):
        with pytest.raises(TypeError, match="^samples: expected real numbers"):
            single.map(wrong, COLUMNS[:1])
    with pytest.raises(TypeError, match="threads: expected int, not None"):
        single.map([4e7], COLUMNS[:1], threads=None)


def test_no_samples_give_no_rows_and_no_keys_are_refused(prepared):
    assert prepared.map([], COLUMNS).shape == (0, len(COLUMNS))
    with pytest.raises(ValueError, match="keys: expected at least one"):
        mg.scenario("die").prepare([])


def test_a_prepared_run_knows_its_scenario(prepared, samples):
    run = prepared.run(samples[0])
    assert_array_equal(run.scenario.run()["axial.force"], run["axial.force"])
    assert len(run.profile(0.5)) > 100


def test_samples_of_another_shape_are_an_error(prepared):
    with pytest.raises(ValueError, match="3 keys"):
        prepared.map(np.ones((4, 2)), COLUMNS)
    with pytest.raises(ValueError, match="2 values for 3 keys"):
        prepared.run([1.0, 2.0])
    with pytest.raises(ValueError, match="threads"):
        prepared.map(np.ones((4, 3)), COLUMNS, threads=-1)


def test_values_with_names_find_their_keys(prepared, samples):
    pandas = pytest.importorskip("pandas")
    expected = prepared.map(samples, COLUMNS)
    frame = pandas.DataFrame(samples, columns=KEYS)[KEYS[::-1]]
    assert_array_equal(prepared.map(frame, COLUMNS), expected)
    assert_array_equal(prepared.map({key: frame[key].to_numpy() for key in KEYS}, COLUMNS), expected)
    assert_array_equal(prepared.run(frame.iloc[0])["axial.force"], prepared.run(samples[0])["axial.force"])
    assert_array_equal(prepared.map(pandas.DataFrame(samples), COLUMNS), expected)  # columns without names
    with pytest.raises(ValueError, match="expected the keys"):
        prepared.map(frame.rename(columns={KEYS[0]: "modulus"}), COLUMNS)
    with pytest.raises(ValueError, match="expected the keys"):
        prepared.map(frame[KEYS[:2]], COLUMNS)
    with pytest.raises(ValueError, match="expected the keys"):
        prepared.map(frame[[*KEYS, KEYS[0]]], COLUMNS)
    single = mg.scenario("die").prepare(KEYS[1:2])
    series = pandas.Series([4e7, 5e7], index=["a", "b"])
    assert_array_equal(single.map(series, COLUMNS[:1]), single.map([4e7, 5e7], COLUMNS[:1]))


WALLS = """
model = "hertz"
particle.radius = "1 mm"
material = { youngs_modulus = "1 GPa", poisson_ratio = 0.3 }
loading.configuration = "walls"
[[loading.wall]]
name = "left"
normal = [-1, 0, 0]
steps = [{ displacement = "0.02 R0", duration = "1 s" }]
[[loading.wall]]
name = "right"
normal = [1, 0, 0]
gap = "10 um"
steps = [{ displacement = "0.02 R0", duration = "1 s" }]
"""


def test_a_column_that_one_run_lacks_is_nan_there_alone():
    single = mg.Scenario(WALLS).prepare(["loading.wall[1].gap"])
    table = single.map([1e-5, 0.0, 5e-6], ["max(right.force)"])  # without a gap, left and right are one class
    assert np.isfinite(table[[0, 2]]).all() and np.isnan(table[1]).all()
    with pytest.raises(ValueError, match="did you mean 'right.force'"):
        single.map(np.empty((0, 1)), ["max(right.forc)"])


def test_a_wall_has_its_columns_even_where_the_scenario_itself_merges_it():
    merged = mg.Scenario(WALLS.replace('gap = "10 um"', 'gap = "0 um"')).prepare(["loading.wall[1].gap"])
    assert np.isfinite(merged.map([1e-5], ["max(right.force)"])).all()


def test_names_of_derivatives_are_checked():
    derived = mg.scenario("die").replace({"sensitivities.keys": ["material.yield_stress"]})
    prepared = derived.prepare(["material.youngs_modulus"])
    slope = "end(`d(axial.force)/d(material.yield_stress)`)"
    assert prepared.map([1e9], [slope])[0, 0] > 0.0
    for wrong in ("axial.forc)/d(material.yield_stress", "axial.force)/d(material.poisson_ratio"):
        with pytest.raises(ValueError, match="unknown name"):
            prepared.map([1e9], [f"end(`d({wrong})`)"])


def test_names_with_other_characters_need_backquotes():
    single = mg.scenario("oblique-die").prepare(["material.youngs_modulus"])
    with pytest.raises(ValueError, match="backquotes"):
        single.map([1e9], ["max(lateral-x.force)"])
    assert single.map([1e9], ["max(`lateral-x.force`)"])[0, 0] > 0.0


def test_one_text_is_no_list_of_keys():
    with pytest.raises(TypeError, match="list of keys"):
        mg.scenario("die").prepare("material.yield_stress")


def test_a_run_while_the_interpreter_ends_comes_to_its_end(tmp_path):
    code = """
        import os
        import monograin as mg

        class Late:
            def __init__(self):
                self.scenario = mg.scenario("hertz")
                self.cycle = self  # so that only the end of the interpreter deletes it

            def __del__(self):
                os.write(1, self.scenario._core.run().status.encode())

        late = Late()
        """
    code = textwrap.dedent(code)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, timeout=60, text=True)
    assert (done.returncode, done.stdout) == (0, "complete")


@pytest.mark.parametrize("call", ["run([5e7])", "map([[5e7]] * 100, ['max(axial.force)'])"])
def test_a_process_may_end_while_a_thread_runs(call, tmp_path):
    code = f"""
        import threading, time
        import monograin as mg

        prepared = mg.scenario("die").prepare(["material.yield_stress"])

        def work():
            while True:
                prepared.{call}

        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.2)
        """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], cwd=tmp_path, capture_output=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, b"")


def test_one_key_takes_a_plain_array():
    single = mg.scenario("die").prepare(["material.yield_stress"])
    table = single.map([4e7, 5e7, 6e7], ["max(axial.force)"])
    assert table.shape == (3, 1)
    assert (np.diff(table[:, 0]) > 0.0).all()
    assert single.map(np.empty((0, 1)), ["max(axial.force)"]).shape == (0, 1)


def test_a_prepared_scenario_survives_pickling(prepared, samples):
    again = pickle.loads(pickle.dumps(prepared))
    assert again.keys == prepared.keys
    assert_array_equal(again.run(samples[0])["axial.force"], prepared.run(samples[0])["axial.force"])


def largest_force(scenario: mg.Scenario) -> float:
    return float(np.nanmax(scenario.run()["axial.force"]))


def test_scenarios_run_in_other_processes(samples):
    scenarios = [mg.scenario("die").replace(dict(zip(KEYS, map(float, values)))) for values in samples[:4]]
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        assert list(pool.map(largest_force, scenarios)) == [largest_force(scenario) for scenario in scenarios]


def test_runs_in_threads_give_the_same(prepared, samples):
    expected = [prepared.run(values)["axial.force"] for values in samples]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for run, force in zip(pool.map(prepared.run, samples), expected):
            assert_array_equal(run["axial.force"], force)


def test_other_threads_go_on_during_map(prepared, samples):
    many = np.tile(samples, (40, 1))
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        result = pool.submit(prepared.map, many, COLUMNS, threads=1)
        counted = 0
        while not result.done():
            counted += 1
            time.sleep(0.001)
    assert counted > 20
    assert_array_equal(result.result()[: len(samples)], prepared.map(samples, COLUMNS))


def processor_time(process: int) -> float:
    """Seconds that the cores have spent on a process."""
    times = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[11:13]
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


def interrupted(code: str, cwd) -> tuple[str, float]:
    """Output of a child process that gets Ctrl-C amid its work, and the seconds it took to end.

    The child writes a line before the work begins. The signal comes after half a second of the child's processor
    time, so that the work has begun on a busy machine, too.

    A process in the background of a script ignores SIGINT, and so do its children, unless that is changed. The
    child handles it as a program in the foreground of a terminal does.
    """
    with subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code)],
        cwd=cwd,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as child:
        try:
            assert child.stdout is not None
            assert child.stdout.readline().strip() == "ready"
            begin = processor_time(child.pid)
            while child.poll() is None and processor_time(child.pid) < begin + 0.5:
                time.sleep(0.01)
            child.send_signal(signal.SIGINT)
            start = time.monotonic()
            output, _ = child.communicate(timeout=60)
        finally:
            child.kill()  # nothing, where it has ended
    return output.strip(), time.monotonic() - start


def test_an_interrupt_stops_map_and_keeps_what_is_there(tmp_path):
    output, seconds = interrupted(
        """
        import numpy as np, monograin as mg
        prepared = mg.scenario("die").prepare(["material.yield_stress"])
        samples = np.linspace(4e7, 6e7, 100_000)
        print("ready", flush=True)
        try:
            prepared.map(samples, ["max(axial.force)"], threads=2)
        except mg.Interrupted as stop:
            done = stop.statuses == "complete"
            rows = np.flatnonzero(done)[:3]
            same = [prepared.map(samples[[row]], ["max(axial.force)"])[0, 0] == stop.table[row, 0] for row in rows]
            print(min(done.sum(), 1), min((~done).sum(), 1), all(same), np.isnan(stop.table[~done]).all())
        """,
        tmp_path,
    )
    assert output == "1 1 True True"
    assert seconds < 10.0


@pytest.mark.filterwarnings("ignore:.* runs warn:RuntimeWarning")
def test_an_interrupted_sweep_goes_on_where_it_was(tmp_path):
    (tmp_path / "die.toml").write_text(mg.scenario("die").text)
    (tmp_path / "long.toml").write_text(
        'scenario = "die.toml"\ndesign = "grid"\n[vary]\n'
        '"material.poisson_ratio" = { from = 0.2, to = 0.48, points = 60 }\n'
        '"material.yield_stress" = { from = "20 MPa", to = "100 MPa", points = 160, scale = "log" }\n'
    )
    output, seconds = interrupted(
        """
        import monograin as mg
        print("ready", flush=True)
        try:
            mg.sweep("long.toml", "out", threads=1)
        except KeyboardInterrupt:
            print("stopped")
        """,
        tmp_path,
    )
    assert output == "stopped"
    assert seconds < 10.0
    (journal,) = (tmp_path / "out").glob("*.journal")
    kept = journal.read_bytes().count(b"\n")
    assert 3 < kept < 9600
    table = mg.sweep(tmp_path / "long.toml", tmp_path / "out")
    assert len(table) == 9600
    assert not list((tmp_path / "out").glob("*.journal"))
    assert (table["status"] == "complete").all()


def test_an_interrupt_stops_a_calibration(tmp_path):
    output, seconds = interrupted(
        """
        import monograin as mg
        print("ready", flush=True)
        try:
            while True:
                mg.calibrate(mg.scenario_folder() / "calibrate" / "uniaxial.toml", "out")
        except KeyboardInterrupt:
            print("stopped")
        """,
        tmp_path,
    )
    assert output == "stopped"
    assert seconds < 10.0


def test_a_key_is_listed_once_and_keys_are_texts():
    with pytest.raises(mg.ScenarioError, match="twice"):
        mg.scenario("die").prepare(["material.yield_stress", "material.yield_stress"])
    with pytest.raises(TypeError, match="keys"):
        mg.scenario("die").prepare([1])


def test_values_of_a_run_are_one_row(prepared, samples):
    with pytest.raises(ValueError, match="shape"):
        prepared.run(samples[:1])


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"columns": 3}, "columns: expected Sequence[str], not 3"),
        ({"columns": ["end(axial.force)"], "threads": "x"}, "threads: expected int, not 'x'"),
        ({"columns": np.array(["end(axial.force)"]), "threads": 1.5}, "threads: expected int, not 1.5"),
    ],
)
def test_a_wrong_argument_of_map_is_named_beside_samples_in_lists(arguments, sentence):
    prepared = mg.scenario("die").prepare(["material.youngs_modulus", "material.yield_stress"])
    with pytest.raises(TypeError) as caught:
        prepared.map([[1e9, 4e7], [1e9, 5e7]], **arguments)
    assert str(caught.value) == sentence


def test_samples_of_unequal_lengths_are_named_with_their_keys():
    prepared = mg.scenario("die").prepare(["material.youngs_modulus", "material.yield_stress"])
    with pytest.raises(TypeError, match="^samples: expected numbers, not sequences of unequal lengths"):
        prepared.map([[1e9, 4e7], [1e9]], ["end(axial.force)"])
    samples = {"material.youngs_modulus": [1e9, 2e9], "material.yield_stress": [4e7]}
    with pytest.raises(ValueError, match=r"\(2,\) for 'material.youngs_modulus', \(1,\) for 'material.yield_stress'"):
        prepared.map(samples, ["end(axial.force)"])

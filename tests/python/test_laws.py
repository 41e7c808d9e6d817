"""Laws, against formulas written here, against each other, and against runs."""

from __future__ import annotations

import concurrent.futures
import csv
import inspect
import math
import pathlib
import subprocess
import sys
import textwrap
import time
import tomllib

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import monograin as mg

laws = mg.laws
ROOT = pathlib.Path(__file__).resolve().parents[2]
ROUNDING = 1e-14


def test_hertz_is_the_own_formula():
    modulus = laws.hertz.composite_modulus(2e9, 0.25)
    assert modulus == pytest.approx(2e9 / (1.0 - 0.0625), rel=ROUNDING)
    overlap = np.linspace(0.0, 1e-4, 11)
    force = laws.hertz.force(modulus, 0.01, overlap)
    assert_allclose(force, 4.0 / 3.0 * modulus * np.sqrt(0.01) * overlap**1.5, rtol=ROUNDING)
    assert_allclose(laws.hertz.contact_radius(0.01, overlap), np.sqrt(0.01 * overlap), rtol=ROUNDING)
    assert_allclose(laws.hertz.energy(modulus, 0.01, overlap), 0.4 * force * overlap, rtol=ROUNDING)


def test_arguments_broadcast_and_scalars_stay_scalars():
    force = laws.hertz.force(np.array([[1e9], [2e9]]), 0.01, [1e-5, 2e-5, 3e-5])
    assert force.shape == (2, 3)
    assert force[1, 2] == laws.hertz.force(2e9, 0.01, 3e-5)
    assert isinstance(laws.hertz.force(2e9, 0.01, 3e-5), float)
    with pytest.raises(ValueError, match="one has 2 elements where another has 3"):
        laws.hertz.force([1e9, 2e9], 0.01, [1e-5, 2e-5, 3e-5])
    with pytest.raises(ValueError, match="do not broadcast"):
        laws.mdr.elastic_force([1e9, 2e9], 0.01, [[1e-5, 2e-5, 3e-5]])
    assert laws.hertz.force(np.ones((4, 1)), np.ones(3), np.full((2, 1, 1), 1e-5)).shape == (2, 4, 3)


def test_a_law_writes_its_result_into_an_array_of_the_caller():
    overlap = np.linspace(1e-5, 1e-3, 5000)
    expected = laws.hertz.force(1e9, 0.01, overlap)
    for target in (np.empty(5000), np.empty((5000, 2))[:, 1], np.empty(10_000)[::-2]):
        assert laws.hertz.force(1e9, 0.01, overlap, out=target) is target
        assert_array_equal(target, expected)
    alone = np.empty(())
    assert laws.hertz.force(1e9, 0.01, overlap[7], out=alone) is alone
    assert alone == expected[7]
    table = np.empty((2, 3))
    laws.similarity.force([[1e7], [2e7]], 0.3, 0.01, [1e-5, 2e-5, 3e-5], rule="corrected", out=table)
    assert_array_equal(table, laws.similarity.force([[1e7], [2e7]], 0.3, 0.01, [1e-5, 2e-5, 3e-5], rule="corrected"))


def test_the_array_for_the_result_may_share_memory_with_arguments():
    overlap = np.linspace(1e-5, 1e-3, 5000)
    expected = laws.hertz.force(1e9, 0.01, overlap)
    same = overlap.copy()
    laws.hertz.force(1e9, 0.01, same, out=same)
    assert_array_equal(same, expected)
    # Every element is read after the one before it was written, if that were done in place.
    shifted = np.append(overlap, 0.0)
    laws.hertz.force(1e9, 0.01, shifted[:-1], out=shifted[1:])
    assert_array_equal(shifted[1:], expected)
    square = np.linspace(1e-5, 1e-3, 2500).reshape(50, 50)
    transposed = laws.hertz.force(1e9, 0.01, square.T)
    laws.hertz.force(1e9, 0.01, square.T, out=square)
    assert_array_equal(square, transposed)
    column = np.full((3, 3), 1e-4)
    laws.hertz.force(1e9, [0.01, 0.02, 0.03], column[:, :1], out=column)
    assert_array_equal(column, [laws.hertz.force(1e9, [0.01, 0.02, 0.03], 1e-4)] * 3)


def test_an_array_that_cannot_hold_the_result_is_refused():
    locked = np.empty(3)
    locked.flags.writeable = False
    for wrong, problem in (
        ([0.0] * 3, r"not \[0.0, 0.0, 0.0\]$"),
        (np.empty(3, dtype=int), "not one of int64$"),
        (np.empty(3, dtype=np.float32), "not one of float32$"),
        (np.empty(3, dtype=">f8"), "not one of >f8, whose byte order is not that of the machine$"),
        (locked, "but this one is read-only$"),
        (1.0, "not 1.0$"),
    ):
        with pytest.raises(TypeError, match=f"^out: expected a writable array of float64, {problem}"):
            laws.hertz.force(1e9, 0.01, [1e-4] * 3, out=wrong)
    for wrong, shape in ((np.empty(4), r"\(4,\)"), (np.empty((1, 3)), r"\(1, 3\)"), (np.empty(()), r"\(\)")):
        with pytest.raises(ValueError, match=rf"^out: its shape is {shape}; expected that of the result, \(3,\)"):
            laws.hertz.force(1e9, 0.01, [1e-4] * 3, out=wrong)
    with pytest.raises(TypeError, match="^modulus: expected real numbers"):
        laws.hertz.force("x", 0.01, 1e-4, out=np.empty(()))


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("hard", [False, True])
def test_a_masked_array_for_the_result_is_refused_and_its_values_are_not(step, hard):
    out = np.ma.masked_array(np.full(3 * step, 7.0), mask=[True] + [False] * (3 * step - 1), hard_mask=hard)[::step]
    with pytest.raises(TypeError, match=r"^out: .* not a masked one; hand in its values, out\.data"):
        laws.hertz.force(1e9, 0.01, [1e-4] * 3, out=out)
    assert_array_equal(out.data, [7.0] * 3)
    laws.hertz.force(1e9, 0.01, [1e-4] * 3, out=out.data)
    assert_array_equal(out.data, laws.hertz.force(1e9, 0.01, [1e-4] * 3))
    assert out.mask.tolist() == [True, False, False]


def test_an_error_leaves_elements_of_the_result_as_they_were_or_evaluates_them():
    radius = [0.01, 0.02, -1.0, 0.04]
    expected = laws.hertz.force(1e9, np.abs(radius), 1e-4)
    out = np.full(4, 7.0)
    with pytest.raises(ValueError, match="radius = -1: expected above 0"):
        laws.hertz.force(1e9, radius, 1e-4, out=out)
    assert all(out[k] in (7.0, expected[k]) for k in range(4)), out
    assert out[2:].tolist() == [7.0, 7.0]
    every_other = np.full(8, 7.0)
    with pytest.raises(ValueError, match="radius = -1: expected above 0"):
        laws.hertz.force(1e9, radius, 1e-4, out=every_other[::2])
    assert_array_equal(every_other, np.full(8, 7.0))


def test_without_contact_nothing_acts():
    for force in (
        laws.hertz.force(1e9, 0.01, -1e-5),
        laws.curved_sphere.force(1e9, 0.01, -1e-5),
        laws.mdr.elastic_force(1e9, 0.01, -1e-5),
        laws.similarity.force(1e7, 0.3, 0.01, -1e-5),
        laws.semimech.force(1e9, 0.3, 1e7, 0.01, -1e-5),
        laws.hardening.force(1e7, 0.3, 0.01, -1e-5),
        laws.compressible.loading_force(2.0, 0.1, 3.0, -0.1),
    ):
        assert force == 0.0


def test_one_term_of_the_curved_sphere_is_hertz_and_all_terms_are_its_closed_form():
    overlap = np.linspace(1e-6, 2e-3, 7)
    assert_allclose(
        laws.curved_sphere.force(1e9, 0.01, overlap, terms="1"), laws.hertz.force(1e9, 0.01, overlap), rtol=1e-12
    )
    a = laws.curved_sphere.contact_radius(0.01, overlap) / 0.01
    assert_allclose(a * np.arctanh(a) * 0.01, overlap, rtol=1e-12)
    expected = 1e9 * 0.01**2 * ((1.0 + a**2) * np.arctanh(a) - a)
    # The difference of two numbers of the order of a, for a result of the order of a^3.
    assert_allclose(laws.curved_sphere.force(1e9, 0.01, overlap), expected, rtol=1e-9)


@pytest.mark.parametrize(
    "force, energy",
    [
        (laws.hertz.force, laws.hertz.energy),
        (laws.curved_sphere.force, laws.curved_sphere.energy),
        (laws.mdr.elastic_force, laws.mdr.elastic_energy),
    ],
)
def test_the_energy_is_the_work_of_the_force(force, energy):
    overlap, step = 5e-4, 1e-7
    slope = (energy(1e9, 0.01, overlap + step) - energy(1e9, 0.01, overlap - step)) / (2.0 * step)
    assert slope == pytest.approx(force(1e9, 0.01, overlap), rel=1e-7)


def test_the_line_contact_inverts():
    stress = np.geomspace(1e3, 5e7, 9)
    strain = laws.line_contact.strain(1e9, stress)
    assert_allclose(laws.line_contact.stress(1e9, strain), stress, rtol=1e-12)
    width = laws.line_contact.half_width(1e9, stress)
    assert_allclose(width, np.sqrt(8.0 * stress / (math.pi * 1e9)), rtol=ROUNDING)
    expected = 2.0 * stress / (math.pi * 1e9) * (2.0 * np.log(4.0 / width) - 1.0)
    assert_allclose(strain, expected, rtol=1e-13)


def test_a_law_is_nan_beyond_its_end():
    assert_array_equal(np.isnan(laws.line_contact.stress(1e9, [0.1, 0.45])), [False, True])
    assert_array_equal(np.isnan(laws.similarity.force(1e7, 0.3, 0.01, [0.005, 0.01])), [False, True])
    assert_array_equal(np.isnan(laws.mdr.elastic_force(1e9, 0.01, [0.01, 0.021])), [False, True])
    assert_array_equal(np.isnan(laws.packing.stress([0.7, 0.9], 1e7, 0.45)), [True, False])
    assert math.isnan(laws.hertz.force(1e9, 0.01, math.nan))


def test_parameters_that_no_law_has_are_errors():
    with pytest.raises(ValueError):
        laws.semimech.force(1e9, 0.3, -1.0, 0.01, 1e-4)
    with pytest.raises(ValueError, match="expected one of 'parabolic', 'corrected'"):
        laws.similarity.force(1e7, 0.3, 0.01, 1e-4, rule="flat")
    with pytest.raises(ValueError):
        laws.hardening.force(1e7, 1.5, 0.01, 1e-4)
    for force in (lambda walls: laws.hardening.force(1e7, 0.5, 0.01, 1e-4, configuration=walls), lambda walls: laws.semimech.force(1e9, 0.3, 1e7, 0.01, 1e-4, configuration=walls)):
        with pytest.raises(ValueError, match="configuration = 'Die' is not known; expected one of 'simple', 'die'"):
            force("Die")


@pytest.mark.parametrize(
    "wrong", [None, "1 GPa", 1j, [1e9, [1e9, 1e9]], np.array(["1e9"]), np.array(["2020"], dtype="M8"), np.timedelta64(1, "s")]
)
def test_arguments_that_are_no_numbers_are_errors_that_name_them(wrong):
    with pytest.raises(TypeError, match="^modulus: expected (real )?numbers, not"):
        laws.hertz.force(wrong, 0.01, 1e-4)


def test_a_word_of_a_wrong_type_is_an_error_that_names_it():
    with pytest.raises(TypeError, match="^configuration: expected str, not None"):
        laws.semimech.force(1e9, 0.3, 1e7, 0.01, 1e-4, configuration=None)


def test_integers_are_numbers_up_to_the_largest_float():
    assert laws.hertz.force(10**9, np.float32(0.5), True) == laws.hertz.force(1e9, 0.5, 1.0)
    with pytest.raises(OverflowError):
        laws.hertz.force(10**400, 0.01, 1e-4)


def test_complex_numbers_among_objects_are_refused():
    for wrong in (np.complex128(1.0), 1j):
        with pytest.raises(TypeError, match="^modulus: expected real numbers, not"):
            laws.hertz.force(np.array([1e9, wrong], dtype=object), 0.01, 1e-4)


def test_none_and_missing_values_of_pandas_are_nan_in_an_array_and_no_number_alone():
    pandas = pytest.importorskip("pandas")
    for missing in (None, pandas.NA):
        force = laws.hertz.force(1e9, 0.01, [1e-4, missing])
        assert_array_equal(force, [laws.hertz.force(1e9, 0.01, 1e-4), np.nan])
        with pytest.raises(TypeError, match="^overlap: expected real numbers, not"):
            laws.hertz.force(1e9, 0.01, missing)


@pytest.mark.filterwarnings("ignore:the matrix subclass:PendingDeprecationWarning")
def test_a_matrix_gives_the_numbers_of_an_array():
    overlap = np.array([[1e-4, 2e-4], [3e-4, 4e-4]])
    for kind in (float, object):
        matrix = np.asmatrix(overlap.astype(kind))
        assert_array_equal(laws.hertz.force(1e9, 0.01, matrix), laws.hertz.force(1e9, 0.01, overlap))


def test_a_peel_curve_needs_two_states_and_single_numbers():
    radii = np.linspace(0.0, 1e-3, 101)
    for points in (-1, 0, 1):
        with pytest.raises(ValueError, match=f"points = {points}: expected 2 or more"):
            laws.mdr.peel_curve(radii, radii**2 / 0.02, 1e9, 0.1, points=points)
    with pytest.raises(TypeError, match="^modulus: expected float, not "):
        laws.mdr.peel_curve(radii, radii**2 / 0.02, [1e9, 2e9], 0.1)


def test_other_threads_go_on_during_a_peel_curve():
    radii = np.linspace(0.0, 1e-3, 101)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        result = pool.submit(laws.mdr.peel_curve, radii, radii**2 / 0.02, 1e9, 0.1, points=40_000)
        counted = 0
        while not result.done():
            counted += 1
            time.sleep(0.001)
    assert counted > 20
    assert len(result.result().force) == 40_000


def test_masked_elements_are_nan():
    force = laws.hertz.force(1e9, 0.01, np.ma.array([1e-4, 2e-4], mask=[False, True]))
    assert_array_equal(force, [laws.hertz.force(1e9, 0.01, 1e-4), np.nan])


def test_arrays_of_any_layout_give_the_numbers_of_their_elements():
    overlap = np.linspace(1e-5, 1e-3, 24).reshape(4, 6)
    for view in (overlap, overlap[::2, ::-3], overlap.T, np.asfortranarray(overlap), overlap.astype(np.float32)):
        expected = [[laws.hertz.force(1e9, 0.01, float(value)) for value in row] for row in view]
        assert_array_equal(laws.hertz.force(1e9, 0.01, view), expected)
    many = np.linspace(1e-5, 1e-3, 10_000)
    assert_array_equal(laws.hertz.force(1e9, 0.01, many)[::997], [laws.hertz.force(1e9, 0.01, d) for d in many[::997]])
    assert laws.hertz.force(1e9, 0.01, np.zeros((0, 3))).shape == (0, 3)


def test_other_threads_go_on_during_a_law():
    overlap = np.linspace(1e-5, 1e-3, 2_000_000)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        result = pool.submit(laws.semimech.force, 1e9, 0.3, 1e7, 0.01, overlap)
        counted = 0
        while not result.done():
            counted += 1
            time.sleep(0.001)
    assert counted > 20
    assert np.isfinite(result.result()).all()


def test_ctrl_c_ends_a_law(tmp_path):
    code = """
        import os, signal, threading, time
        import numpy as np
        import monograin as mg

        overlap = np.broadcast_to([1e-4], 60_000_000)
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        start = time.process_time()
        try:
            mg.laws.semimech.force(1e9, 0.3, 1e7, 0.01, overlap)
        except KeyboardInterrupt:
            print(time.process_time() - start)
        """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 2.5


def test_a_module_of_laws_lists_its_laws_only():
    assert dir(laws.mdr) == sorted(laws.mdr.__all__)


def test_curves_of_arrays_can_be_compared():
    radii = np.linspace(0.0, 1e-3, 101)
    first, again = (laws.mdr.peel_curve(radii, radii**2 / 0.02, 1e9, 0.1) for _ in range(2))
    assert first == again
    assert first != laws.mdr.peel_curve(radii, radii**2 / 0.02, 1e9, 0.2)


def test_elastic_and_plastic_contacts_refuse_what_no_material_has():
    with pytest.raises(ValueError, match="modulus = -1: expected above 0"):
        laws.hertz.force(-1.0, 0.01, 1e-3)
    with pytest.raises(ValueError, match="poisson_ratio = 0.7"):
        laws.mdr.plastic_force(1e9, 0.7, 5e7, 0.01, 1e-3)
    with pytest.raises(ValueError, match="radius = 0"):
        laws.mdr.elastic_force(1e9, [0.01, 0.0], 1e-3)
    yields = laws.mdr.yield_overlap(1e9, 0.3, 5e7, 0.01)
    force = laws.mdr.plastic_force(1e9, 0.3, 5e7, 0.01, np.array([0.5, 1.0, 2.0]) * yields)
    assert np.isnan(force[0]) and (force[1:] > 0.0).all()
    assert np.isnan(laws.hertz.force(np.nan, 0.01, 1e-3))


def test_a_parabola_pulls_off_as_johnson_kendall_and_roberts_say():
    energy = np.array([0.1, 1.0, 10.0])
    force = laws.mdr.pull_off_force(1e9, 0.01, energy, profile="parabola")
    assert_allclose(force, -1.5 * math.pi * energy * 0.01, rtol=1e-12)
    assert (laws.mdr.pull_off_radius(1e9, 0.01, energy) > 0.0).all()


def test_a_concave_profile_peels_as_its_closed_form_says():
    # g3D = c2 r^2 + c4 r^4 has the image 2 c2 x^2 + (8/3) c4 x^4.
    c2, c4, modulus, energy = -0.05, 0.4, 1.0, 1e-4
    radii = np.linspace(0.0, 0.9, 200)
    curve = laws.mdr.peel_curve(radii, c2 * radii**2 + c4 * radii**4, modulus, energy, control="force", points=50)
    a = curve.contact_radius
    stretch = np.sqrt(2.0 * math.pi * a * energy / modulus)
    image = 2.0 * c2 * a**2 + 8.0 / 3.0 * c4 * a**4
    free = 8.0 / 3.0 * modulus * c2 * a**3 + 64.0 / 15.0 * modulus * c4 * a**5
    assert_allclose(curve.displacement, image - stretch, rtol=1e-8, atol=1e-10)
    assert_allclose(curve.force, free - 2.0 * modulus * a * stretch, rtol=1e-8, atol=1e-10)
    assert a[0] == 0.9 and curve.force.argmin() == 49
    assert a[-1] == pytest.approx(0.31211213267490756, rel=1e-8)
    assert curve.force[-1] == pytest.approx(-0.0077406004808598792, rel=1e-8)


def test_a_sphere_given_by_samples_pulls_off_as_the_parabola():
    radius, energy = 0.01, 0.1
    modulus = 1e9
    radii = np.linspace(0.0, 1e-3, 101)
    curve = laws.mdr.peel_curve(radii, radii**2 / (2.0 * radius), modulus, energy, control="force")
    assert curve.force[-1] == pytest.approx(-1.5 * math.pi * energy * radius, rel=1e-10)


def test_a_profile_that_is_none_is_refused():
    good = np.linspace(0.0, 1.0, 10)
    with pytest.raises(ValueError):
        laws.mdr.peel_curve(good[:4], good[:4] ** 2, 1.0, 1e-4)
    with pytest.raises(ValueError):
        laws.mdr.peel_curve(good[::-1], good**2, 1.0, 1e-4)
    with pytest.raises(ValueError, match="modulus = 0"):
        laws.mdr.peel_curve(good, good**2, 0.0, 1e-4)
    with pytest.raises(ValueError, match="'weight' is not known"):
        laws.mdr.peel_curve(good, good**2, 1.0, 1e-4, control="weight")


def test_the_images_of_powers_are_known():
    assert laws.mdr.power_ratio(0.0) == pytest.approx(1.0, rel=ROUNDING)
    assert laws.mdr.power_ratio(1.0) == pytest.approx(math.pi / 2.0, rel=ROUNDING)
    assert laws.mdr.power_ratio(2.0) == pytest.approx(2.0, rel=ROUNDING)
    image = laws.mdr.power_profile_1d(3.0, 2.5, 0.2)
    assert laws.mdr.power_profile_3d(image / 0.2**2.5, 2.5, 0.2) == pytest.approx(3.0 * 0.2**2.5, rel=1e-13)


def test_the_plastic_contact_continues_the_elastic_one():
    overlap = laws.mdr.yield_overlap(1e9, 0.3, 5e7, 0.01)
    modulus = laws.hertz.composite_modulus(1e9, 0.3)
    # The mean pressure is continuous by definition of first yield, and with it the force of Hertz's parabola.
    elastic = laws.mdr.elastic_force(modulus, 0.01, overlap, profile="parabola")
    assert laws.mdr.plastic_force(1e9, 0.3, 5e7, 0.01, overlap) == pytest.approx(elastic, rel=1e-12)
    pressure = laws.mdr.plastic_mean_pressure(5e7, 0.01, overlap)
    assert pressure == pytest.approx(5e7 * (1.0 + 1.75 * math.exp(-4.4 * overlap / 0.01)), rel=1e-14)


def test_a_pair_inverts_and_a_rigid_body_leaves_the_strength():
    force = laws.similarity.pair_force(1e7, 0.25, 0.01, 0.02, 1e-4)
    assert laws.similarity.pair_approach(1e7, 0.25, 0.01, 0.02, force) == pytest.approx(1e-4, rel=1e-12)
    assert laws.similarity.pair_strength(1e7, math.inf, 0.25) == 1e7
    assert laws.similarity.pair_contact_radius(0.25, 0.01, math.inf, 1e-4) > 0.0
    step = 1e-9
    slope = (
        laws.similarity.pair_work(1e7, 0.25, 0.01, 0.02, 1e-4 + step)
        - laws.similarity.pair_work(1e7, 0.25, 0.01, 0.02, 1e-4 - step)
    ) / (2.0 * step)
    assert slope == pytest.approx(force, rel=1e-7)


def test_the_power_law_nearest_to_ludwik_is_near():
    found = laws.ludwik.power_law(1e10, 5e6, 15.5e6, 0.35)
    strain = np.linspace(0.05, 1.0, 20)
    difference = laws.ludwik.stress(5e6, 15.5e6, 0.35, strain) / (found.strength * strain**found.exponent) - 1.0
    assert np.abs(difference).max() < 0.05
    assert 0.0 < found.residual < 1e6
    fixed = laws.ludwik.power_law(1e10, 5e6, 15.5e6, 0.35, fit="exponent")
    assert fixed.strength == pytest.approx(20.5e6, rel=ROUNDING)


def test_the_compressible_law_is_continuous_and_unloads_from_its_end():
    at = 0.1
    below, above = laws.compressible.loading_force(2.0, at, 3.0, [at * (1 - 1e-12), at * (1 + 1e-12)])
    assert below == pytest.approx(above, rel=1e-10)
    largest = laws.compressible.loading_force(2.0, at, 3.0, 0.3)
    hertz = laws.compressible.hertz_stiffness(20.0, 0.3)
    assert laws.compressible.unloading_force(2.0, at, 3.0, hertz, 0.3, 0.3) == pytest.approx(largest, rel=1e-14)
    way = laws.compressible.unloading_force(2.0, at, 3.0, hertz, 0.3, np.linspace(0.0, 0.3, 50))
    assert way[0] == 0.0
    assert (np.diff(way) >= 0.0).all()


@pytest.mark.parametrize(
    "name, force",
    [
        ("hertz", lambda m, r, d: laws.hertz.force(laws.hertz.composite_modulus(m["E"], m["nu"]), r, d)),
        ("semimech", lambda m, r, d: laws.semimech.force(m["E"], m["nu"], m["Y"], r, d, configuration=m["walls"])),
        ("hardening", lambda m, r, d: laws.hardening.force(m["kappa"], m["mu"], r, d, configuration=m["walls"])),
        ("similarity", lambda m, r, d: laws.similarity.force(m["kappa"], m["mu"], r, d)),
    ],
)
def test_laws_are_what_runs_compute(name, force):
    scenario = mg.scenario(name)
    run = scenario.run()
    d = run["axial.displacement"]
    turns = np.flatnonzero(np.diff(d) < 0.0)
    first = turns[0] + 1 if len(turns) else len(d)
    radius = float(run.history.header["R0"])
    expected = force(_numbers(scenario), radius, d[:first])
    assert np.isfinite(expected).all()
    assert_allclose(run["axial.force"][:first], expected, rtol=1e-8, atol=1e-9 * np.nanmax(expected))


CEL = (1e9, 0.3, 2e7, 0.01)  # E, nu, Y, R0
# Influence of the forces at two opposite walls on either of them, times E R0: 4000 terms of the series of the sphere.
CEL_SPHERE = 0.456150299556335 - 0.224018049811986


def test_a_contact_of_cel_has_the_values_of_its_closed_forms():
    # Computed independently of this program, with R0 = E = 1.
    lines = (ROOT / "tests" / "models" / "cel" / "reference" / "point_values.csv").read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    ratio, zeta, h, p, limit, u = (
        np.array([float(row[name]) for row in rows]) for name in ("E_over_Y", "zeta", "h", "p_over_Y", "H", "u_H")
    )
    material = (1.0, 0.3, 1.0 / ratio, 1.0)
    assert len(rows) == 20
    assert_allclose(laws.cel.indentation(*material, zeta), h, rtol=1e-9)
    assert_allclose(laws.cel.loading_force(*material, zeta), limit, rtol=1e-12)
    assert_allclose(laws.cel.loading_overlap(*material, zeta), h + u, rtol=1e-12)
    assert_allclose(laws.cel.mean_pressure(*material, zeta), p / ratio, rtol=1e-12)
    assert_allclose(laws.cel.unloading_force(*material, zeta, h + u), limit, rtol=1e-9)


def test_a_contact_of_cel_is_hertzs_up_to_yield():
    overlap = np.linspace(0.0, laws.cel.yield_overlap(*CEL), 9)
    modulus = laws.hertz.composite_modulus(*CEL[:2])
    radius = laws.hertz.contact_radius(CEL[3], overlap)
    assert radius[-1] == pytest.approx(laws.cel.yield_radius(*CEL), rel=ROUNDING)
    expected = laws.hertz.force(modulus, CEL[3], overlap)
    assert_allclose(laws.cel.loading_overlap(*CEL, radius), overlap, rtol=1e-13)
    assert_allclose(laws.cel.loading_force(*CEL, radius), expected, rtol=1e-13)
    assert_allclose(laws.cel.unloading_force(*CEL, radius[-1], overlap), expected, rtol=1e-13)
    assert_allclose(laws.cel.unloading_contact_radius(*CEL, radius[-1], overlap), radius, rtol=1e-13)
    assert laws.cel.indentation(*CEL, radius[-1]) == pytest.approx(0.0, abs=1e-20)
    tiny = laws.cel.mean_pressure(*CEL, 1e-160)
    assert tiny == pytest.approx(1e-155 * laws.cel.mean_pressure(*CEL, 1e-5), rel=1e-12)


def test_a_dent_of_cel_unloads_from_the_end_of_loading_to_its_indentation():
    largest = np.array([[0.1], [0.3], [0.8]]) * CEL[3]
    opens, ends = laws.cel.indentation(*CEL, largest), laws.cel.loading_overlap(*CEL, largest)
    overlap = opens + np.linspace(0.0, 1.0, 11) * (ends - opens)
    force = laws.cel.unloading_force(*CEL, largest, overlap)
    assert_allclose(force[:, :1], 0.0, atol=1e-9 * force.max())
    assert_allclose(force[:, -1:], laws.cel.loading_force(*CEL, largest), rtol=1e-10)
    # The stiffness of a frictionless contact is that of a flat punch of its radius.
    middle, step = overlap[:, 1:-1], 1e-6 * (ends - opens)
    rise = laws.cel.unloading_force(*CEL, largest, middle + step) - laws.cel.unloading_force(*CEL, largest, middle - step)
    stiffness = 2.0 * laws.hertz.composite_modulus(*CEL[:2]) * laws.cel.unloading_contact_radius(*CEL, largest, middle)
    assert_allclose(rise / (2.0 * step), stiffness, rtol=1e-6)


def test_a_contact_of_cel_is_refused_or_nan_beyond_its_domain():
    radius = CEL[3]
    assert_array_equal(np.isnan(laws.cel.loading_force(*CEL, [-1.0, 0.0, radius, 1.1 * radius, np.nan])), [0, 0, 0, 1, 1])
    ends = laws.cel.loading_overlap(*CEL, 0.3 * radius)
    force = laws.cel.unloading_force(*CEL, 0.3 * radius, [0.0, ends, 1.001 * ends, np.nan])
    assert_array_equal(np.isnan(force), [0, 0, 1, 1])
    assert force[0] == 0.0
    assert math.isnan(laws.cel.indentation(math.nan, *CEL[1:], 0.1 * radius))
    with pytest.raises(ValueError, match="yield_stress = 0: expected above 0"):
        laws.cel.yield_radius(1e9, 0.3, 0.0, 0.01)
    with pytest.raises(ValueError, match="poisson_ratio = 0.6"):
        laws.cel.mean_pressure(1e9, 0.6, 2e7, 0.01, 1e-3)


def test_a_contact_of_cel_is_that_of_a_run_at_small_overlaps():
    modulus, ratio, yield_stress, radius = CEL
    run = mg.Scenario(
        {
            "model": "cel",
            "particle": {"radius": radius},
            "material": {"youngs_modulus": modulus, "poisson_ratio": ratio, "yield_stress": yield_stress},
            "loading": {
                "configuration": "simple",
                "steps": [
                    {"displacement": "0.02 R0", "duration": "1 s"},
                    {"displacement": "0 R0", "duration": "1 s", "until": {"force": "0 N"}},
                ],
            },
        }
    ).run()
    inside = (run["axial.force"] > 0.0) & (run["time"] > 0.0)
    a, force, displacement, regime = (
        run[f"axial.{name}"][inside] for name in ("contact_radius", "force", "displacement", "regime")
    )
    # The elastic sphere moves under both forces.
    overlap = displacement + CEL_SPHERE * force / (modulus * radius)
    # Only the core, which flows from the yield of the contact on, differs from this contact.
    for name, of_force, of_overlap in (("elastic", 1e-12, 1e-9), ("plastic", 2e-4, 1e-3)):
        now = regime == name
        assert now.sum() > 5, name
        assert_allclose(laws.cel.loading_force(*CEL, a[now]), force[now], rtol=of_force)
        assert_allclose(laws.cel.mean_pressure(*CEL, a[now]), run["axial.pressure"][inside][now], rtol=of_force)
        assert_allclose(laws.cel.loading_overlap(*CEL, a[now]), overlap[now], rtol=of_overlap)
    now = regime == "unloaded"
    assert now.sum() > 5
    of_dent = np.linspace(0.0, laws.cel.loading_overlap(*CEL, a.max()), 20_001)
    forces = laws.cel.unloading_force(*CEL, a.max(), of_dent)
    radii = laws.cel.unloading_contact_radius(*CEL, a.max(), of_dent)
    assert_allclose(np.interp(force[now], forces, radii), a[now], rtol=1e-4)
    assert_allclose(np.interp(force[now], forces, of_dent), overlap[now], rtol=1e-3)
    assert laws.cel.indentation(*CEL, a.max()) == pytest.approx(run["axial.displacement"][-1], rel=1e-3)


def _numbers(scenario: mg.Scenario) -> dict:
    """Constants of a scenario's material in SI units, by their symbols, and its wall set."""
    header = scenario.run().history.header
    found = mg.parameters(scenario)
    numbers = {"E": header.get("E"), "nu": header.get("nu"), "Y": header.get("Y")}
    numbers = {key: float(value) for key, value in numbers.items() if value}
    document = tomllib.loads(scenario.text)
    for key, symbol in (("strength", "kappa"), ("hardening_exponent", "mu")):
        if key in found:
            numbers[symbol] = found[key].value
    return {**numbers, "walls": document["loading"]["configuration"]}


def test_every_law_says_what_it_returns_and_in_which_unit():
    modules = [value for name, value in vars(laws).items() if inspect.ismodule(value)]
    functions = [getattr(module, name) for module in modules for name in module.__all__]
    functions = [function for function in functions if inspect.isfunction(function)]
    assert len(functions) > 40
    for function in functions:
        text = inspect.getdoc(function)
        assert text.startswith("Returns "), function
        for argument in inspect.signature(function).parameters:
            assert argument in text, f"{function.__module__}.{function.__name__}: {argument}"
        assert "Source: " in text, function
    for module in modules:
        assert "Source: " in inspect.getdoc(module), module

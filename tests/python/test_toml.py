"""The writer of TOML text, against the reader of the standard library."""

from __future__ import annotations

import math
import pathlib
import tomllib

import numpy as np
import pytest

from monograin import _toml

DOCUMENT = {
    "title": 'quotes " and \\ and\ttab, \x00 \x1f \x7f, line\nbreak, ü 中 \U0001f600',
    "empty": "",
    "number": 0.1,
    "tiny": 5e-324,
    "negative zero": -0.0,
    "large": 1e300,
    "whole": 3.0,
    "count": -(2**63),
    "is_on": True,
    "list": [1, 2.5, "a", [True, []]],
    "quoted key.with dots": 1,
    "": "empty key",
    "table": {"x": 1, "inner": {"y": [1.0, 2.0]}, "empty": {}},
    "steps": [
        {"displacement": "0.4 R0", "until": {"force": 0.0}},
        {"repeat": 2, "steps": [{"hold": True}, {"force": 1.0}]},
    ],
    "mixed": [{"a": 1}, 2],
}


def test_what_is_written_reads_back():
    assert tomllib.loads(_toml.document(DOCUMENT)) == DOCUMENT


@pytest.mark.parametrize("key", DOCUMENT)
def test_values_read_back_in_one_line(key):
    text = _toml.text_of(DOCUMENT[key])
    assert "\n" not in text
    assert tomllib.loads(f"x = {text}")["x"] == DOCUMENT[key]


def test_numbers_keep_every_bit():
    draw = np.random.default_rng(0)
    bits = draw.integers(0, 2**64, 20_000, dtype=np.uint64).view(np.float64)
    values = [float(value) for value in bits if math.isfinite(value)]
    assert tomllib.loads(f"x = {_toml.text_of(values)}")["x"] == values


def test_a_float_stays_a_float():
    assert isinstance(tomllib.loads(f"x = {_toml.text_of(2.0)}")["x"], float)
    assert isinstance(tomllib.loads(f"x = {_toml.text_of(True)}")["x"], bool)


def test_numpy_and_paths_are_plain_values():
    given = {"a": np.float32(0.5), "b": np.int16(3), "c": np.bool_(True), "d": np.array([[1.0, 2.0]]), "e": np.str_("x")}
    expected = {"a": 0.5, "b": 3, "c": True, "d": [[1.0, 2.0]], "e": "x"}
    assert tomllib.loads(_toml.document(given)) == expected
    assert _toml.text_of(pathlib.PurePosixPath("a/b")) == '"a/b"'


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, [1.0, math.nan], 2**63, -(2**63) - 1, "\ud800"])
def test_what_toml_or_a_scenario_cannot_have_is_refused(value):
    with pytest.raises(ValueError, match="material.x"):
        _toml.text_of(value, "material.x")


@pytest.mark.parametrize("value", [None, object(), 1j, {1: 2}, {1, 2}, b"bytes"])
def test_other_types_are_refused(value):
    with pytest.raises(TypeError, match="material.x"):
        _toml.text_of(value, "material.x")
    with pytest.raises(TypeError):
        _toml.document({"x": value})

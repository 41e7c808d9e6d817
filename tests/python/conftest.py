"""Fixtures that the tests share."""

from __future__ import annotations

import os
import pathlib
import subprocess

import pytest

import monograin as mg

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> pathlib.Path:
    """The program, of the same sources: MONOGRAIN_PROGRAM, or that of tools/demo."""
    path = pathlib.Path(os.environ.get("MONOGRAIN_PROGRAM", ROOT / "build" / "demo" / "monograin"))
    if not path.is_file():
        pytest.skip(f"{path}: there is no program to compare with; tools/python-test builds it")
    return path


@pytest.fixture(scope="session")
def run_program(program):
    """Runs the program with arguments, in a folder."""

    def call(*arguments: object, cwd: pathlib.Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([program, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False)

    return call


@pytest.fixture(scope="session")
def die() -> mg.Scenario:
    return mg.scenario("die")

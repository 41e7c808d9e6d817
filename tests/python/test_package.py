"""Types, documentation, and the installed distribution."""

from __future__ import annotations

import ast
import importlib
import importlib.metadata
import inspect
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import types
import typing

import pytest

import monograin as mg

ROOT = pathlib.Path(__file__).resolve().parents[2]


def backend_module(name: str) -> types.ModuleType:
    """A module of the folder that builds the wheel."""
    sys.path.insert(0, str(ROOT / "python" / "backend"))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.pop(0)


@pytest.fixture(scope="module")
def typed_package(tmp_path_factory) -> pathlib.Path:
    """Folder with the package as the wheel has it: the sources, the stubs of the laws, and the compiled module."""
    pytest.importorskip("mypy")
    folder = tmp_path_factory.mktemp("typed")
    laws = shutil.copytree(ROOT / "python" / "monograin", folder / "monograin") / "laws"
    for name, text in backend_module("law_stubs").law_stubs(laws):
        (laws / name).write_text(text)
    module = pathlib.Path(mg._core.__file__)
    (folder / "monograin" / module.name).symlink_to(module)
    return folder


def checked_types(module: str, *arguments: object, cwd: pathlib.Path, package: pathlib.Path) -> tuple[int, str]:
    """Exit code and output of mypy or stubtest, for the package in a folder."""
    paths = {"MYPYPATH": str(package), "PYTHONPATH": str(package), "MYPY_CACHE_DIR": str(cwd / "cache")}
    command = [sys.executable, "-m", module, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, env={**os.environ, **paths})
    return done.returncode, done.stdout + done.stderr


def test_every_public_name_is_documented():
    for name in mg.__all__:
        value = getattr(mg, name)
        if inspect.ismodule(value) or isinstance(value, str):
            continue
        assert inspect.getdoc(value), name
        if inspect.isclass(value):
            for member, entry in vars(value).items():
                if not member.startswith("_") and (inspect.isfunction(entry) or isinstance(entry, (property, classmethod))):
                    assert inspect.getdoc(entry), f"{name}.{member}"


def test_annotations_of_public_functions_can_be_read():
    public = [getattr(mg, name) for name in mg.__all__]
    owners = [value for value in public if inspect.isclass(value) and not issubclass(value, BaseException)]
    functions = [entry for owner in owners for entry in vars(owner).values()] + public
    functions = [entry for entry in functions if inspect.isfunction(entry) and not entry.__name__.startswith("_")]
    assert len(functions) > 20
    for function in functions:
        assert "return" in typing.get_type_hints(function), function


def test_the_distribution_lists_its_files_with_their_digests():
    try:
        distribution = importlib.metadata.distribution("monograin")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the package is not installed")
    assert distribution.version == mg.__version__
    assert distribution.requires is not None
    assert distribution.requires[0] == "numpy"
    files = {str(file): file for file in distribution.files or []}
    assert "monograin/py.typed" in files
    assert "monograin/laws/hertz.pyi" in files
    assert "monograin/scenarios/die.toml" in files
    metadata = distribution.metadata
    assert metadata["Requires-Python"] == ">=3.11"
    assert metadata["License"] == "GPL-3.0-or-later"
    assert "Programming Language :: Python :: 3.11" in metadata.get_all("Classifier")
    for name in metadata.get_all("License-File"):
        assert f"monograin-{mg.__version__}.dist-info/{name}" in files
    notices = distribution.read_text("THIRD_PARTY_NOTICES")
    for library in ("Eigen/*", "boost/*", "fmt/*", "nlohmann/*", "pybind11/*", "toml++/*", "xxhash.h"):
        assert f"Files: {library}\n" in notices, library
    assert any(name.startswith("monograin/_core") and name.endswith(".so") for name in files)
    for name, file in files.items():
        if file.hash is not None:
            assert file.size == pathlib.Path(str(file.locate())).stat().st_size, name


def test_a_source_distribution_has_all_that_a_wheel_is_built_from(tmp_path):
    backend = backend_module("monograin_build")
    name = backend.build_sdist(str(tmp_path))
    assert name == f"monograin-{mg.__version__}.tar.gz"
    with tarfile.open(tmp_path / name) as archive:
        files = {member.name.removeprefix(f"monograin-{mg.__version__}/") for member in archive if member.isfile()}
    # Any file stands for the module, which is not built here.
    needed = {source.relative_to(ROOT).as_posix() for source, _ in backend.package_files(ROOT / "README.md")}
    assert len(needed) > 40
    assert needed <= files
    assert {"PKG-INFO", "pyproject.toml", "CMakeLists.txt", "CMakePresets.json", "python/CMakeLists.txt"} <= files
    assert not any(file.startswith(("build/", "runs/")) or file.endswith((".so", ".pyc")) for file in files)


def test_the_stubs_name_what_the_module_has():
    tree = ast.parse((ROOT / "python/monograin/_core.pyi").read_text())

    def stated(body: list[ast.stmt]) -> set[str]:
        return {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}

    def found(owner: object) -> set[str]:
        return {name for name in dir(owner) if not name.startswith("_")}

    assert stated(tree.body) == found(mg._core)
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            assert stated(node.body) - {"__init__"} == found(getattr(mg._core, node.name)), node.name


def test_sources_and_stubs_pass_the_type_checker(tmp_path):
    mypy = pytest.importorskip("mypy")
    assert mypy
    environment = {**os.environ, "MYPY_CACHE_DIR": str(tmp_path)}
    checked = subprocess.run([sys.executable, "-m", "mypy"], cwd=ROOT, capture_output=True, text=True, env=environment)
    assert checked.returncode == 0, checked.stdout


def check_program(text: str, folder: pathlib.Path, package: pathlib.Path) -> tuple[int, str]:
    (folder / "program.py").write_text(text)
    arguments = ("--strict", "--ignore-missing-imports", "program.py")
    return checked_types("mypy", *arguments, cwd=folder, package=package)


def test_a_users_program_passes_the_type_checker(tmp_path, typed_package):
    code, said = check_program(
        "import numpy as np\nimport monograin as mg\n"
        "run: mg.Run = mg.scenario('die').run()\n"
        "table: np.ndarray[object, np.dtype[np.float64]] = mg.scenario().prepare(['x']).map([[1.0]], ['a'])\n"
        "has_statuses = len(run) > 3\n"
        "either = mg.scenario().prepare(['x']).map([[1.0]], ['a'], statuses=has_statuses)\n",
        tmp_path,
        typed_package,
    )
    assert code == 0, said
    code, said = check_program(
        "import monograin as mg\nmg.scenario('die').run().statsu\nmg.Scenario.load(3)\n", tmp_path, typed_package
    )
    assert code == 1
    assert '"statsu"' in said
    assert 'Argument 1 to "load"' in said


def test_a_law_of_numbers_is_a_float_and_one_of_arrays_an_array_to_the_type_checker(tmp_path, typed_package):
    code, said = check_program(
        "import numpy as np\nimport monograin as mg\nfrom numpy.typing import NDArray\n"
        "from typing import assert_type\n"
        "force = mg.laws.mdr.elastic_force\n"
        "many = np.ones(3)\n"
        "assert_type(force(1.0, 1, np.float64(1.0), profile='parabola'), float)\n"
        "assert_type(force(1.0, 1.0, [1.0]), NDArray[np.float64])\n"
        "assert_type(force(many, radius=1.0, overlap=1.0), NDArray[np.float64])\n"
        "assert_type(force(1.0, 1.0, many, out=many), NDArray[np.float64])\n",
        tmp_path,
        typed_package,
    )
    assert code == 0, said
    wrong = ("force(1.0, 1.0)", "force(1.0, 1.0, 1.0, 1.0)", "force(1.0, 1.0, many, profile=1)", "force(1.0, 1.0, many, out=[1.0])")
    text = "import numpy as np\nimport monograin as mg\nforce = mg.laws.mdr.elastic_force\nmany = np.ones(3)\n"
    code, said = check_program(text + "\n".join(wrong) + "\n", tmp_path, typed_package)
    assert code == 1
    for line in range(5, 5 + len(wrong)):
        assert f"program.py:{line}: error:" in said, said


def test_the_stubs_of_laws_state_the_arguments_that_laws_take(tmp_path, typed_package):
    arguments = ("monograin.laws", "--ignore-missing-stub")
    code, said = checked_types("mypy.stubtest", *arguments, cwd=tmp_path, package=typed_package)
    assert code == 0, said
    # A stub without an argument is found.
    stub = typed_package / "monograin" / "laws" / "hertz.pyi"
    text = stub.read_text()
    stub.write_text(text.replace("overlap: ArrayLike, ", "").replace("overlap: _Number, ", ""))
    code, said = checked_types("mypy.stubtest", *arguments, cwd=tmp_path, package=typed_package)
    stub.write_text(text)
    assert code == 1
    assert "monograin.laws.hertz.force is inconsistent" in said

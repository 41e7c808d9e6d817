"""Builds wheel and source distribution (PEP 517) with the standard library and the system's CMake and Ninja."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from typing import Any, Iterator, Mapping, Optional

from law_stubs import law_stubs

Settings = Optional[Mapping[str, Any]]

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = "build/python"
NAME = "monograin"
# Ready scenarios, with what they name and what sweeps, calibrates and plans them.
DATA = ("*.toml", "*.csv", "sweeps/*", "calibrate/*", "design/*")
# Files of licences in a wheel, and where they come from. The second one has those of the libraries compiled in.
LICENCES = {"LICENSE": "LICENSE", "THIRD_PARTY_NOTICES": "cmake/copyright"}
# Folders that a source distribution does without.
NO_SOURCE = ("build", "runs", "dist")


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    return []


def get_requires_for_build_sdist(config_settings: Settings = None) -> list[str]:
    return []


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None) -> str:
    """Builds the module and writes the wheel. Returns the wheel's file name.

    Args:
        config_settings: `build-folder` names the folder of a build, whose objects are used and whose options are kept.
    """
    module = build_module((config_settings or {}).get("build-folder"))
    name = f"{NAME}-{version()}-{tag()}.whl"
    with WheelFile(pathlib.Path(wheel_directory) / name) as wheel:
        for source, target in package_files(module):
            wheel.add(target, source.read_bytes(), mode=0o755 if source == module else 0o644)
        for stub, text in law_stubs(ROOT / "python" / NAME / "laws"):
            wheel.add(f"{NAME}/laws/{stub}", text.encode())
        for target, text in metadata_files().items():
            wheel.add(target, text.encode())
    return name


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    """Writes the wheel's metadata, without building the module. Returns the name of their folder."""
    for target, text in metadata_files().items():
        file = pathlib.Path(metadata_directory) / target
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
    return f"{NAME}-{version()}.dist-info"


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """Writes the sources, as git knows them where this is a clone. Returns the archive's file name."""
    base = f"{NAME}-{version()}"
    with tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for source in source_files():
            archive.add(ROOT / source, f"{base}/{source}", recursive=False)
        text = metadata().encode()
        entry = tarfile.TarInfo(f"{base}/PKG-INFO")
        entry.size = len(text)
        archive.addfile(entry, io.BytesIO(text))
    return f"{base}.tar.gz"


# --- what goes in


def version() -> str:
    """The version that CMakeLists.txt gives the project."""
    found = re.search(r"^project\(monograin VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
    if found is None:
        raise RuntimeError("CMakeLists.txt: there is no project(monograin VERSION ...)")
    return found.group(1)


def tag() -> str:
    """Interpreter, its binary interface, and the platform; the module runs on no other."""
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{interpreter}-{interpreter}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def package_files(module: pathlib.Path) -> Iterator[tuple[pathlib.Path, str]]:
    """Every file of the package, with its place in the wheel."""
    package = ROOT / "python" / NAME
    for pattern in ("**/*.py", "**/*.pyi", "**/py.typed"):
        for source in sorted(package.glob(pattern)):
            yield source, f"{NAME}/{source.relative_to(package).as_posix()}"
    yield module, f"{NAME}/{module.name}"
    scenarios = ROOT / "scenarios"
    for pattern in DATA:
        for source in sorted(scenarios.glob(pattern)):
            if source.is_file():
                yield source, f"{NAME}/scenarios/{source.relative_to(scenarios).as_posix()}"


def source_files() -> list[str]:
    listed = subprocess.run(
        ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode == 0 and listed.stdout:
        return sorted(name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file())
    files = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
    return sorted(path.as_posix() for path in files if path.parts[0] not in NO_SOURCE and path.name != "PKG-INFO")


def metadata() -> str:
    """Core metadata, version 2.1, of the table `[project]` in pyproject.toml."""
    about = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {about['name']}",
        f"Version: {version()}",
        f"Summary: {about['description']}",
        f"Keywords: {','.join(about['keywords'])}",
        f"License: {about['license']['text']}",
        *(f"License-File: {name}" for name in LICENCES),
        *(f"Classifier: {classifier}" for classifier in about["classifiers"]),
        f"Requires-Python: {about['requires-python']}",
        "Description-Content-Type: text/markdown",
        *(f"Requires-Dist: {requirement}" for requirement in about["dependencies"]),
    ]
    for extra, requirements in about["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f"Requires-Dist: {requirement} ; extra == '{extra}'" for requirement in requirements]
    readme = (ROOT / str(about["readme"])).read_text()
    return "\n".join([*lines, "", readme])


def metadata_files() -> dict[str, str]:
    folder = f"{NAME}-{version()}.dist-info"
    wheel = f"Wheel-Version: 1.0\nGenerator: monograin_build\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    return {
        f"{folder}/METADATA": metadata(),
        f"{folder}/WHEEL": wheel,
        **{f"{folder}/{name}": (ROOT / source).read_text() for name, source in LICENCES.items()},
    }


# --- building


def build_module(folder: Optional[str] = None) -> pathlib.Path:
    """Compiles the module in a folder [build/python]; what is there already is not compiled again. Returns its file."""
    cmake = shutil.which("cmake")
    if cmake is None or shutil.which("ninja") is None:
        raise RuntimeError("cmake or ninja was not found. On Debian: tools/install-deps --python")
    # A virtual environment may be gone at the next call; the interpreter that it stands on is not.
    interpreter = os.path.realpath(sys.executable)
    build = ROOT / (folder or BUILD)
    options = ["-DMONOGRAIN_BUILD_PYTHON=ON", f"-DPython_EXECUTABLE={interpreter}"]
    if folder is None:
        options += ["--preset=release", "-DMONOGRAIN_BUILD_TESTS=OFF"]
    subprocess.run([cmake, "-B", str(build), *options], cwd=ROOT, check=True)
    subprocess.run([cmake, "--build", str(build), "--target", "monograin_python"], cwd=ROOT, check=True)
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    module = build / "python" / NAME / f"_core{suffix}"
    if not module.is_file():
        raise RuntimeError(f"{module}: was not built; is another Python found than {interpreter}?")
    return module


class WheelFile:
    """A wheel that is being written; its list of files comes last."""

    def __init__(self, path: pathlib.Path) -> None:
        self._zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self._record: list[tuple[str, str, str]] = []

    def __enter__(self) -> WheelFile:
        return self

    def __exit__(self, *_: object) -> None:
        record = f"{NAME}-{version()}.dist-info/RECORD"
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([*self._record, (record, "", "")])
        self._write(record, text.getvalue().encode(), 0o644)
        self._zip.close()

    def add(self, target: str, content: bytes, mode: int = 0o644) -> None:
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self._record.append((target, f"sha256={digest}", str(len(content))))
        self._write(target, content, mode)

    def _write(self, target: str, content: bytes, mode: int) -> None:
        # One date for all, so that equal contents make equal wheels.
        entry = zipfile.ZipInfo(target, (1980, 1, 1, 0, 0, 0))
        entry.external_attr = (0o100000 | mode) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        self._zip.writestr(entry, content)

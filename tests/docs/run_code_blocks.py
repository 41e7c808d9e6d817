#!/usr/bin/env python3
"""Runs the code blocks of README.md, of the documentation and of models/README.md.

Usage: tests/docs/run_code_blocks.py --program FILE [--python FILE] [PAGE...]

Each page gets a scratch folder with a copy of scenarios/ (and of plots/, where it speaks of them), in which its blocks
run one after the other, with the program on the PATH:

    sh        has to end with exit code 0
    console   lines that begin with "$ " are commands; they print what stands below them, "..." for any text
    toml      a scenario, a sweep, a calibration, a design or a figure definition that the program has to accept
    python    has to end without an exception; skipped, and counted, where the interpreter has no package monograin
    cpp       has to compile as a part of the tree
    cmake     cannot be run here: needs a mark

Blocks in other languages (text, json) are no code. A comment on the line before a block changes what is done with it:

    <!-- test: exit 3 -->                           the commands end with this exit code
    <!-- test: file own.toml -->                    toml: is also left in the scratch folder under this name
    <!-- test: fragment of scenarios/die.toml -->   toml: these keys replace those of a ready scenario
    <!-- test: not run: WHY; tested by COMMAND -->  is not run here

Exits with 1 if a block fails, or is of a language that needs a mark and has none.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# By tools/docs.
MADE = ("docs/generated/", "docs/reference/models/", "docs/reference/api/", "docs/tables/",
        "docs/howto/python-examples/")
RUN_LANGUAGES = ("sh", "console", "toml", "python", "cpp")
MARKED_LANGUAGES = ("cmake", "dockerfile")
LONGEST = 600  # seconds that a block may take


@dataclass
class Block:
    page: str
    line: int
    language: str
    text: str
    mark: str


class Failure(Exception):
    pass


def blocks_of(page):
    """Fenced blocks of a page, with the mark on the line before."""
    blocks = []
    fence, mark, indent, language, start, body = None, "", "", "", 0, []
    for number, line in enumerate((ROOT / page).read_text(encoding="utf-8").splitlines(), 1):
        if fence is None:
            opened = re.match(r"^(\s*)(`{3,}|~{3,})\s*([^`\s]*)", line)
            if opened:
                indent, fence, language = opened.groups()
                start, body = number, []
            else:
                found = re.match(r"^\s*<!-- test: (.*?)\s*-->\s*$", line)
                if found:
                    mark = found.group(1)
                elif line.strip():
                    mark = ""
        elif re.match(rf"^\s*{fence[0]}{{{len(fence)},}}\s*$", line):
            text = "\n".join(each.removeprefix(indent) for each in body) + "\n"
            blocks.append(Block(page, start, language.lower(), text, mark))
            fence, mark = None, ""
        else:
            body.append(line)
    if fence is not None:
        raise Failure(f"{page}:{start}: the block does not end")
    return blocks


def toml_value(value):
    """A value written as TOML, in one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(toml_value(each) for each in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(each)}" for key, each in value.items()) + " }"
    return repr(value)


def overrides_of(tree):
    """A fragment as values of --set: key=value, or table.key=value."""
    for key, value in tree.items():
        if isinstance(value, dict):
            for inner, each in value.items():
                yield f"{key}.{inner}={toml_value(each)}"
        else:
            yield f"{key}={toml_value(value)}"


class Page:
    """Runs the blocks of one page."""

    def __init__(self, name, folder, program, python):
        self.folder, self.program, self.python = folder, program, python
        shutil.copytree(ROOT / "scenarios", folder / "scenarios")
        text = (ROOT / name).read_text(encoding="utf-8")
        if "plots" in text or "atlas" in text:
            shutil.copytree(ROOT / "plots", folder / "plots")
        if "examples/" in text and (ROOT / "examples").is_dir():
            shutil.copytree(ROOT / "examples", folder / "examples")
        (folder / ".bin").mkdir()
        (folder / ".bin" / "monograin").symlink_to(program)
        self.environment = {**os.environ, "PATH": f"{folder / '.bin'}{os.pathsep}{os.environ['PATH']}"}

    def call(self, *command, text=None):
        try:
            return subprocess.run(command, cwd=self.folder, env=self.environment, input=text, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=LONGEST, check=False)
        except subprocess.TimeoutExpired:
            raise Failure(f"took more than {LONGEST} s") from None

    def expect(self, code, result):
        if result.returncode != code:
            raise Failure(f"ended with {result.returncode}, expected {code}:\n{result.stdout}")

    def run(self, block):
        code = int(block.mark.split()[1]) if block.mark.startswith("exit ") else 0
        if block.language == "sh":
            self.expect(code, self.call("bash", "-euo", "pipefail", "-c", block.text))
        elif block.language == "console":
            self.run_console(block.text, code)
        elif block.language == "python":
            self.expect(code, self.call(self.python, "-", text=block.text))
        elif block.language == "cpp":
            folders = [part for folder in ("include", "models", "src") for part in ("-I", ROOT / folder)]
            self.expect(code, self.call("g++", "-std=c++20", "-fsyntax-only", *folders, "-isystem", "/usr/include/eigen3",
                                        "-x", "c++", "-", text=block.text))
        else:
            self.run_toml(block, code)

    def run_console(self, text, code):
        parts = re.split(r"^\$ ", text, flags=re.MULTILINE)
        if parts[0].strip():
            raise Failure("the block does not begin with '$ '")
        for part in parts[1:]:
            command, _, expected = part.partition("\n")
            while command.endswith("\\"):
                more, _, expected = expected.partition("\n")
                command = command[:-1] + more.removeprefix("> ")
            result = self.call("bash", "-euo", "pipefail", "-c", command)
            self.expect(code, result)
            lines = [line.rstrip() for line in result.stdout.strip().splitlines()]
            pattern = ".*".join(re.escape(piece) for piece in "\n".join(
                line.rstrip() for line in expected.strip().splitlines()).split("..."))
            if not re.fullmatch(pattern, "\n".join(lines), re.DOTALL):
                raise Failure(f"'{command}' printed\n{result.stdout}where the page has\n{expected}")

    def run_toml(self, block, code):
        tree = tomllib.loads(block.text)
        if block.mark.startswith("fragment of "):
            base = block.mark.removeprefix("fragment of ")
            settings = [part for override in overrides_of(tree) for part in ("--set", override)]
            self.expect(code, self.call("monograin", "check", base, *settings))
            return
        file = self.folder / "scenarios" / "block.toml"
        if block.mark.startswith("file "):
            file = self.folder / block.mark.removeprefix("file ")
        file.write_text(block.text, encoding="utf-8")
        if "vary" in tree or "design" in tree:
            command = ["sweep", file, "--design-only", "-o", self.folder / "design"]
        elif "program" in tree:
            command = ["design", file, "-o", self.folder / "expected"]
        elif "free" in tree:
            command = ["calibrate", file, "--quiet", "-o", self.folder / "calibration"]
        elif "panel" in tree or "curve" in tree:
            command = ["atlas", file.stem, "--plots", file.parent, "-o", self.folder / "atlas"]
        else:
            command = ["check", file]
        self.expect(code, self.call("monograin", *command))


def has_package(python):
    return subprocess.run([python, "-c", "import monograin"], capture_output=True, check=False).returncode == 0


def main():
    parser = argparse.ArgumentParser(description="Runs the code blocks of README.md and of the documentation.")
    parser.add_argument("--program", required=True, help="monograin")
    parser.add_argument("--python", default=sys.executable, help="interpreter for python blocks")
    parser.add_argument("pages", nargs="*", help="pages, from the top of the tree; default: all")
    arguments = parser.parse_args()
    program = pathlib.Path(arguments.program).resolve()
    python_runs = has_package(arguments.python)
    pages = arguments.pages or ["README.md", "models/README.md"] + sorted(
        page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md")
        if not page.relative_to(ROOT).as_posix().startswith(MADE))

    run, failed, skipped, not_run = 0, 0, 0, []
    for page in pages:
        blocks = blocks_of(page)
        with tempfile.TemporaryDirectory() as scratch:
            place = Page(page, pathlib.Path(scratch), program, arguments.python)
            for block in blocks:
                where = f"{block.page}:{block.line}"
                is_known = block.language in RUN_LANGUAGES + MARKED_LANGUAGES
                if is_known and block.mark.startswith("not run: "):
                    reason = block.mark.removeprefix("not run: ")
                    not_run.append(f"{where}: {block.language}: {reason}")
                    for path in re.findall(r"\b(?:tests|tools)/[\w./-]*\w", reason):
                        if not (ROOT / path).exists():
                            failed += 1
                            print(f"{where}: there is no {path}, which is said to test it", file=sys.stderr)
                elif block.language == "python" and not python_runs:
                    skipped += 1
                elif block.language in RUN_LANGUAGES:
                    try:
                        place.run(block)
                        run += 1
                    except (Failure, OSError, tomllib.TOMLDecodeError) as problem:
                        failed += 1
                        print(f"{where}: {block.language}: {problem}", file=sys.stderr)
                elif is_known:
                    failed += 1
                    print(f"{where}: {block.language}: needs a comment that says why it is not run", file=sys.stderr)
    if not_run:
        print(f"{len(not_run)} blocks are not run:")
        for line in not_run:
            print(f"  {line}")
    if skipped:
        print(f"{skipped} python blocks are skipped: {arguments.python} has no package monograin")
    print(f"code blocks of {len(pages)} pages:")
    print(f"{run} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Runs the notebooks of the site, as Jupyter would.

Usage: tests/docs/run_notebooks.py

Each notebook that the site offers runs in a scratch folder with the arguments that Jupyter gives its interpreter. Lines
that speak to Jupyter alone (%matplotlib) are left out. Exits with 1 if a notebook fails, or if a script of
examples/python has none.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def code_of(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    lines = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code").splitlines()
    return "\n".join(line for line in lines if not line.startswith("%"))


def main():
    failed = 0
    scripts = sorted((ROOT / "examples" / "python").glob("*.py"))
    for script in scripts:
        notebook = ROOT / "docs" / "howto" / "python-examples" / f"{script.stem}.ipynb"
        if not notebook.is_file():
            failed += 1
            print(f"{script.relative_to(ROOT)}: the site has no notebook of it", file=sys.stderr)
            continue
        with tempfile.TemporaryDirectory() as scratch:
            done = subprocess.run([sys.executable, "-", "-f", "kernel.json"], input=code_of(notebook), cwd=scratch,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode != 0:
            failed += 1
            print(f"{notebook.relative_to(ROOT)}:\n{done.stdout}", file=sys.stderr)
    print(f"{len(scripts)} notebooks: {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Checks that what README.md, the documentation and the other Markdown files of the tree point to is there.

Usage: tests/docs/check_links.py

- Every relative link and image leads to a file, and an anchor in it to a heading.
- Every path of the tree in a code span (`scenarios/die.toml`, `tools/demo`) exists.
- Every figure of plots/ is shown on some page.
- README.md has at most 900 words.

Exits with 1 where one of these does not hold. Links to what the build of the site makes are counted and not followed
where it has not run.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST_WORDS = 900
TOP = ("bench", "cmake", "docs", "examples", "include", "models", "plots", "python", "scenarios", "src", "tests",
       "tools")
# Folders that docs/generate.py and Sphinx make.
MADE = tuple(ROOT / "docs" / name for name in ("generated", "reference/models", "reference/api", "tables",
                                               "howto/python-examples"))
# Names that stand for others, and what a build or a run makes.
NO_FILES = re.compile(r"NAME|FILE|SCENE|\*|<|\.\.\.|^docs/(generated|reference/(api|models)|tables)")


def pages():
    found = sorted(ROOT.glob("*.md"))
    for folder in ("docs", "models", "src", "scenarios", "tests", "examples", "python"):
        found += sorted((ROOT / folder).rglob("*.md"))
    # Tables in plots/ are made by the program.
    return [*found, ROOT / "plots" / "README.md"]


def without_code(text):
    """The text without code blocks, code spans blanked; and the spans. Directives (```{name}) stay."""
    kept, fence, is_code = [], None, False
    for line in text.splitlines():
        found = re.match(r"^\s*(`{3,}|~{3,}|:{3,})(.*)$", line)
        if found and fence is None:
            fence = found.group(1)
            is_code = not found.group(2).strip().startswith("{")
        elif found and found.group(1).startswith(fence) and not found.group(2).strip():
            fence, is_code = None, False
            continue
        if fence is None or not is_code:
            kept.append(line)
    text = "\n".join(kept)
    spans = re.findall(r"(?<!`)`([^`\n]+)`(?!`)", text)
    return re.sub(r"(?<!`)`[^`\n]+`(?!`)", "code", text), spans


def anchors_of(file):
    anchors = set()
    for heading in re.findall(r"^#+ (.*)$", file.read_text(encoding="utf-8"), re.MULTILINE):
        slug = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        anchors.add(slug)
    return anchors


def links_of(text):
    links = re.findall(r"\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)", text)
    links += re.findall(r"^\s*`{3,}\{(?:figure|image|include|literalinclude)\}\s+(\S+)", text, re.MULTILINE)
    links += re.findall(r"^\s*:{3,}\{(?:figure|image|include|literalinclude)\}\s+(\S+)", text, re.MULTILINE)
    return links


def is_to_be_made(target):
    return any(target.resolve().is_relative_to(folder) and not folder.exists() for folder in MADE)


def check_page(page, faults, shown):
    """Appends what is wrong on a page, collects what it shows, and returns how many links wait for docs/generate.py."""
    text, spans = without_code(page.read_text(encoding="utf-8"))
    name = page.relative_to(ROOT)
    waiting = 0
    for link in links_of(text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        if not path:
            target = page
        elif path.startswith("/"):
            target = ROOT / "docs" / path.lstrip("/")
        else:
            target = page.parent / path
        if is_to_be_made(target):
            waiting += 1
        elif not target.exists():
            faults.append(f"{name}: there is no '{link}'")
        elif anchor and target.suffix == ".md" and anchor not in anchors_of(target):
            faults.append(f"{name}: '{path}' has no heading for '#{anchor}'")
        shown.add(target.resolve())
    for span in spans:
        is_path = re.fullmatch(rf"(?:{'|'.join(TOP)})/[\w./-]+", span)
        if is_path and not NO_FILES.search(span) and not (ROOT / span).exists():
            # Where models speak of their own folder, paths begin there.
            if not (page.parent / span).exists() and not (ROOT / "models" / span).exists():
                faults.append(f"{name}: there is no file '{span}'")
    return waiting


def main():
    faults, shown = [], set()
    checked = pages()
    waiting = sum(check_page(page, faults, shown) for page in checked)
    if waiting:
        print(f"{waiting} links wait for the build of the site")
    for figure in sorted((ROOT / "plots").glob("*.svg")):
        if figure.resolve() not in shown:
            faults.append(f"no page shows plots/{figure.name}")
    words = len((ROOT / "README.md").read_text(encoding="utf-8").split())
    if words > MOST_WORDS:
        faults.append(f"README.md has {words} words; at most {MOST_WORDS} are wanted")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"links of {len(checked)} pages: {len(faults)} faults; README.md: {words} words")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

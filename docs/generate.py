#!/usr/bin/env python3
"""Writes the parts of the documentation that the program itself knows.

Usage: docs/generate.py [--program FILE]

Asks the program for its commands, models and JSON Schema, runs the ready scenarios, and writes

    docs/generated/            parts that pages include, figures, references.bib, doxygen's XML
    docs/reference/models/     a page for each model
    docs/reference/api/        a page for each module of the package, and for each C++ header
    docs/tables/               a page for each table of plots/

These folders are ignored by git. What the program says and what this script knows of it (the meaning of a column, the
dimension of a unit) has to match exactly; a name on one side alone ends the script with a message.
"""

import argparse
import concurrent.futures
import csv
import importlib.util
import inspect
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from xml.etree import ElementTree

DOCS = pathlib.Path(__file__).resolve().parent
ROOT = DOCS.parent
GENERATED = DOCS / "generated"
MODEL_PAGES = DOCS / "reference" / "models"
API_PAGES = DOCS / "reference" / "api"
TABLES = DOCS / "tables"

# Scenarios whose figures pages show.
FIGURES = ("die", "uniaxial", "adhesion", "snap-off", "force", "free-centre", "late-wall", "cycles")

# Modules of the package monograin whose public names users import from the package, in the order of the site.
PYTHON_MODULES = ("runs", "prepared", "tables", "studies", "elements", "catalogue", "errors")

# The headers of include/monograin, in the order in which a reader needs them.
CPP_HEADERS = ("monograin", "scenario", "faults", "run", "status", "history", "prepared", "comparison", "continuum",
               "continuum_difference", "study", "models", "version")

# Programs of examples/cpp that pages show.
CPP_EXAMPLES = ("run_scenario", "own_law", "sweep", "calibrate")

# The dimension of a list of units, by the SI unit in it.
DIMENSIONS = {
    "m": "length",
    "Pa": "stress",
    "J/m^2": "surface energy",
    "N/m": "stiffness",
    "N": "force",
    "s": "time",
    "m/s": "velocity",
    "N/s": "force rate",
    "rad": "angle",
    "1/s": "strain rate",
    "Pa/s": "stress rate",
    "Hz": "frequency",
}

# Words of plots/laws-fe.csv that are models.
MODEL_WORDS = ("hertz", "mdr", "cel", "similarity", "semimech", "hardening", "nonlocal", "compressible")

# Keys in the order in which a scenario file is written.
ORDER = ("title", "model", "particle", "material", "loading", "output", "numerics",
         "sensitivities", "configuration", "centre", "angle",
         "oblique_walls", "name", "normal", "gap", "fixed", "wall", "table", "time", "value", "sine", "mean", "amplitude",
         "frequency", "cycles", "duration", "rate", "until", "steps", "integrator",
         "rtol", "atol")

# Meaning of each column; a column of a contact class stands under the name after the class.
COLUMNS = {
    "time": "time since the start of the program",
    "step": "number of the step of the program, from 1",
    "row": "0 at an output point, -1 just before and 1 just after an event or a corner of the program",
    "apparent_radius": "radius of the sphere that describes the free surface",
    "volume": "volume of the particle",
    "work": "work of all walls on the particle since the start",
    "stored_energy": "part of the work that unloading can recover",
    "dissipation": "part of the work that is dissipated",
    "centre_x": "position of the centre, x",
    "centre_y": "position of the centre, y",
    "centre_z": "position of the centre, z",
    "core_strain": "accumulated equivalent strain of the core",
    "coverage": "measure of the surface area of all dents; contacts meet at about 1.7",
    "margin": "distance from the limit of applicability; 1 unloaded, 0 at the limit",
    "packing_fraction": "volume of the particles over that of the packing",
    "strain": "logarithmic strain of the packing, compression positive; zero where the elastic law has no stress",
    "stress": "stress on the packing",
    "stress_elastic": "stress of the elastic law alone",
    "coordination_number": "mean number of contacts of a particle",
    "plastic_fraction": "share of contacts that have yielded",
    "strain_axial": "logarithmic axial strain, tension positive",
    "strain_lateral": "logarithmic lateral strain, tension positive",
    "p": "hydrostatic pressure",
    "s": "axial minus lateral stress, with sign",
    "q": "magnitude of s (von Mises stress)",
    "stress_axial": "axial stress, tension positive",
    "stress_lateral": "lateral stress, tension positive",
    "relative_density": "density over that of the solid",
    "plastic_strain_volumetric": "volumetric plastic strain",
    "plastic_strain_deviatoric": "deviatoric plastic strain",
    "phi": "strength variable of the yield surface",
    "youngs_modulus": "Young's modulus at this density",
    "yield_function": "yield function: negative inside the yield surface, zero on it",
    "regime": "regime, a name of the table above",
}
CONTACT_COLUMNS = {
    "displacement": "displacement of the wall from first touch towards the initial position of the centre; negative: a gap",
    "overlap": "depth of the wall in the particle of the present (apparent) radius",
    "force": "force of one wall, compression positive",
    "contact_radius": "radius of the contact area; model `nonlocal`: in the reference configuration",
    "contact_radius_deformed": "radius of the contact area in the deformed configuration, as experiments show it",
    "pressure": "force over the area of `contact_radius`; 0 if the contact is open",
    "regime": "regime, a name of the table above",
}


def fail(text):
    sys.exit(f"docs/generate.py: {text}")


def run(*command, cwd=None, codes=(0,)):
    result = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    if result.returncode not in codes:
        fail(f"'{' '.join(map(str, command))}' ended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result.stdout


def find_program(asked):
    """The program that was asked for, or that of the demo or of the release build."""
    if asked:
        return pathlib.Path(asked).resolve()
    for build in ("demo", "release"):
        program = ROOT / "build" / build / "monograin"
        if program.is_file():
            return program
    return fail("there is no program; build it with tools/demo, or name one with --program")


# --- Markdown


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(heading, rows):
    lines = ["| " + " | ".join(heading) + " |", "|" + " --- |" * len(heading)]
    lines += ["| " + " | ".join(cell(c) for c in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def write(name, text, folder=GENERATED):
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


# --- keys, from the JSON Schema


def number(value, units=()):
    """A number as text; an angle in degrees."""
    if "deg" in units:
        return f"{math.degrees(value):g} deg"
    return f"{value:g}" if isinstance(value, float) else str(value)


def units_of(schema):
    """Units that a value may have, in the order of the program."""
    for part in (schema, *schema.get("anyOf", [])):
        found = re.search(r"\(([^()]*)\)(?:\|R0(?:/s)?\))?\[ \\t\]\*\$$", part.get("pattern", ""))
        if found and "anyOf" in schema:
            return found.group(1).replace("\\", "").split("|")
    return []


def si_unit(units):
    found = [unit for unit in units if unit in DIMENSIONS]
    # "N/m" is a surface energy, too, and R0 a length.
    if not found:
        fail(f"no SI unit is known among {units}")
    return found[0]


def range_of(schema):
    """Finite bounds of a number, as text."""
    part = schema["anyOf"][0] if "anyOf" in schema else schema
    if part.get("type") not in ("number", "integer"):
        return ""
    lower = part.get("minimum", part.get("exclusiveMinimum"))
    upper = part.get("maximum", part.get("exclusiveMaximum"))
    if lower is None or upper is None:
        return ""
    units = units_of(schema)
    huge, tiny = 1e17, 1e-5  # bounds of the plausible, not of the law
    open_left, open_right = "exclusiveMinimum" in part, "exclusiveMaximum" in part
    is_low, is_high = abs(lower) >= huge, abs(upper) >= huge
    if 0 < lower <= tiny and not is_low:
        lower, open_left = 0, True
    if upper >= 1e5 and part.get("type") == "number" and "anyOf" in schema:
        is_high = True
    if lower <= -1e5 and "anyOf" in schema:
        is_low = True
    if is_low and is_high:
        return ""
    if is_high:
        return ("> " if open_left else ">= ") + number(lower, units)
    if is_low:
        return ("< " if open_right else "<= ") + number(upper, units)
    return f"{'(' if open_left else '['}{number(lower, units)}, {number(upper, units)}{')' if open_right else ']'}"


def course_of(schema):
    """Tables that may stand for a quantity: values over time, a sine."""
    return next((part["oneOf"] for part in schema["anyOf"] if "oneOf" in part), [])


def accepts(schema):
    """Describes the values that a key takes."""
    if "allOf" in schema and len(schema["allOf"]) == 1:
        schema = schema["allOf"][0]
    if "$ref" in schema or schema.get("type") == "object":
        return "a table"
    if "enum" in schema:
        words = list(dict.fromkeys(str(word) for word in schema["enum"]))
        return ", ".join(f"`{word}`" for word in words)
    if schema.get("const") is True:
        return "`true`"
    if schema.get("type") == "boolean":
        return "`true`, `false`"
    if schema.get("type") == "array":
        items = schema["items"]
        if "$ref" in items or items.get("type") == "object":
            return "an array of tables"
        if schema.get("maxItems") == 3:
            return "three numbers"
        return f"a list: {accepts(items)}"
    units = units_of(schema)
    if units:
        or_table = " or a table" if course_of(schema) else ""
        return f"{DIMENSIONS[si_unit(units)]} [{si_unit(units)}]{or_table}"
    if "anyOf" in schema:
        parts = [accepts(part) for part in schema["anyOf"]]
        return " or ".join(dict.fromkeys(parts))
    if schema.get("type") == "string" and schema.get("minLength"):
        return "name of a file"
    kinds = {"string": "text", "integer": "whole number", "number": "number"}
    kind = schema.get("type")
    if isinstance(kind, list):  # texts that may be written as numbers
        kind = kind[0]
    return kinds.get(kind) or fail(f"a kind of value that this script does not know: {schema}")


def key_table(properties, required, skip=(), order=()):
    """A row for each key; those that `order` names first, in this order (JSON has them by the alphabet)."""
    rows = []
    named = [name for name in order if name in properties]
    for name in named + [name for name in properties if name not in named]:
        schema = properties[name]
        if name in skip:
            continue
        default = schema.get("default")
        if default is None:
            default = "required" if name in required else ""
        elif isinstance(default, bool):
            default = f"`{str(default).lower()}`"
        else:
            default = f"`{number(default, units_of(schema))}`"
        rows.append([f"`{name}`", schema.get("description", ""), accepts(schema), range_of(schema), default])
    return table(["key", "meaning", "takes", "range", "default"], rows)


def steps_of(definition):
    """(key that marks the step, schema) of every form of a step."""
    forms = []
    for form in definition["oneOf"]:
        forms.append((form["required"][0], form))
    return forms


def until_of(definition):
    for _, form in steps_of(definition):
        if "until" in form["properties"]:
            return form["properties"]["until"]["properties"]
    return {}


def all_units(schema, found):
    """Collects every list of units in a schema, by its SI unit."""
    if isinstance(schema, dict):
        if "anyOf" in schema:
            units = units_of(schema)
            if units:
                si = si_unit(units)
                known = found.setdefault(si, [])
                known += [unit for unit in units if unit not in known]
        for part in schema.values():
            all_units(part, found)
    elif isinstance(schema, list):
        for part in schema:
            all_units(part, found)


def write_language(schema):
    """Keys that all models of particles between walls share, and units."""
    definitions = schema["definitions"]
    walls = definitions["mdr"]["properties"]
    loading = definitions["mdr-loading"]["oneOf"]
    keys = {}
    configurations = []
    for alternative in loading:
        for name, value in alternative["properties"].items():
            keys.setdefault(name, value)
        configurations += alternative["properties"]["configuration"]["enum"]
    keys["configuration"] = {**keys["configuration"], "enum": configurations}
    own_walls = next(a for a in loading if "walls" in a["properties"]["configuration"]["enum"])
    wall = own_walls["properties"]["wall"]["items"]
    text = "### At the top of the file\n\n"
    root = {name: value for name, value in walls.items() if name != "mdr"}
    root["model"] = {**root["model"], "enum": [ref["$ref"].rsplit("/", 1)[1] for ref in schema["oneOf"]]}
    text += key_table(root, definitions["mdr"]["required"], (), ORDER)
    text += "\n### `[particle]`\n\n" + key_table(walls["particle"]["properties"], walls["particle"]["required"])
    text += "\n### `[loading]`\n\n" + key_table(keys, ["configuration", "steps"], (), ORDER)
    text += "\n### `[[loading.wall]]`\n\n" + key_table(wall["properties"], wall["required"], (), ORDER)
    text += "\n### `[[loading.steps]]`\n\nA step has one of these forms, identified by its first key.\n"
    for key, form in steps_of(definitions["mdr-step"]):
        text += f"\n`{key}`\n\n" + key_table(form["properties"], form["required"], (), (key, *ORDER))
    text += "\n### A table or a sine in the place of a target\n\nShown for a displacement; a force takes the same keys.\n"
    of_table, of_sine = course_of(dict(steps_of(definitions["mdr-step"]))["displacement"]["properties"]["displacement"])
    sine = of_sine["properties"]["sine"]
    for head, form in (("{ table, time, value }", of_table), ("{ sine = { ... } }", sine)):
        text += f"\n`displacement = {head}`\n\n" + key_table(form["properties"], form["required"], (), ORDER)
    text += "\n### `until`\n\nOne or several conditions; the first that is met ends the step.\n\n"
    conditions = dict(until_of(definitions["mdr-step"]))
    conditions["event"] = {"type": "string", "description": "name of an [event](events.md) of the model"}
    text += key_table(conditions, [])
    text += "\n### `[output]`\n\n" + key_table(walls["output"]["properties"], [])
    text += "\n### `[numerics]`\n\n" + key_table(walls["numerics"]["properties"], [], (), ORDER)
    text += "\n### `[sensitivities]`\n\n" + key_table(walls["sensitivities"]["properties"], ["keys"])
    write("scenario-keys.md", text)

    units = {}
    all_units(schema, units)
    rows = []
    for si, names in units.items():
        # Two signs look alike and mean micro.
        shown = [name for name in names if "μ" not in name]
        rows.append([DIMENSIONS[si], f"`{si}`", ", ".join(f"`{name}`" for name in shown if not name.startswith("R0"))])
    write("units.md", table(["dimension", "a bare number is in", "units"], rows))


# --- models


def sections_of(text):
    """The parts of `monograin models NAME`: heading -> lines."""
    sections = {"": []}
    current = ""
    for line in text.splitlines():
        if line and not line.startswith(" "):
            name, _, rest = line.partition(": ")
            current = name.strip()
            sections.setdefault(current, []).extend([rest] if rest else [])
        elif re.match(r"  (\S| {27}\")", line):
            sections[current].append(line)
        elif line.strip():
            sections[current][-1] += " " + line.strip()
    return sections


def terms(lines):
    rows = []
    for line in lines:
        found = re.match(r"  (\S+?)\s+(\S.*)$", line)
        if not found:
            fail(f"cannot read the line '{line}' of 'monograin models'")
        rows.append((found.group(1), found.group(2)))
    return rows


def words_of(lines):
    return [line.split()[0] for line in lines]


def columns_of(folder):
    """Headings of a history, those of contact classes without the class; and the classes."""
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    classes = [c["name"] for c in record["classes"]]
    with open(folder / "history.csv", encoding="utf-8") as file:
        heading = next(csv.reader(line for line in file if not line.startswith("#")))
    particle, contact = [], []
    for column in heading:
        owner, dot, name = column.partition(".")
        if dot and owner in classes:
            contact.append(name)
        else:
            particle.append(column)
    return list(dict.fromkeys(particle)), list(dict.fromkeys(contact)), record


def check_record(record):
    """Every key of run.json has to stand on the page that tells of it."""
    page = (DOCS / "reference" / "results.md").read_text(encoding="utf-8")
    told = set(re.findall(r"`(\w+)`", page.split("## `run.json`")[1].split("\n## ")[0]))
    missing = [key for key in record if key not in told]
    if missing:
        fail(f"docs/reference/results.md does not tell of {', '.join(missing)} in run.json")


def run_ready_scenarios(program, scratch):
    """Runs every ready scenario; model -> [(name, title, particle columns, contact columns)]."""
    files = sorted((ROOT / "scenarios").glob("*.toml"))

    def one(file):
        with open(file, "rb") as stream:
            title = tomllib.load(stream).get("title", "")
        folder = scratch / file.stem
        plot = ["--plot"] if file.stem in FIGURES else []
        run(program, "run", file, "-o", folder, "--quiet", *plot, codes=(0, 3))
        if plot:
            target = GENERATED / "figures" / f"{file.stem}.svg"
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(folder / "figure.svg", target)
        particle, contact, record = columns_of(folder)
        check_record(record)
        return record["model"], (file.stem, title, particle, contact)

    by_model = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for model, found in pool.map(one, files):
            by_model.setdefault(model, []).append(found)
    return by_model


def split_heading(column):
    found = re.fullmatch(r"([^\[]+)(?:\[(.*)\])?", column)
    return found.group(1), found.group(2)


def column_table(columns, meanings, used):
    rows = []
    for column in columns:
        name, unit = split_heading(column)
        if name not in meanings:
            fail(f"column '{column}' has no meaning in this script")
        used.add(name)
        rows.append([f"`{column}`", meanings[name], "word" if unit is None and name == "regime" else unit or "-"])
    return table(["heading", "holds", "unit"], rows)


def write_limits():
    """Codes of the limits at which runs stop, in the order of their list in the code."""
    source = (ROOT / "models" / "system" / "limit.cpp").read_text(encoding="utf-8")
    entries = re.findall(r'Words\{Limit::\w+,\s*"([^"]+)",\s*((?:"[^"]*"\s*)+)\}', source)
    if len(entries) != source.count("Words{Limit::"):
        fail("the list of limits in models/system/limit.cpp is not written as expected")
    rows = [[f"`{code}`", "".join(re.findall(r'"([^"]*)"', sentence))] for code, sentence in entries]
    write("limit-codes.md", table(["code", "message"], rows))


def footnotes(texts):
    """A letter for each text, equal for texts that differ in numbers only, and the list that the letters refer to."""
    number = r"(?<![\w.])-?\d+(?:\.\d+)?"
    alike = {}
    for text in texts:
        if text:
            alike.setdefault(re.sub(number, "#", text), []).append([float(n) for n in re.findall(number, text)])
    letters = {pattern: chr(ord("a") + k) for k, pattern in enumerate(alike)}
    notes = []
    for pattern, found in alike.items():
        spans = iter([" to ".join(dict.fromkeys(f"{n:g}" for n in (min(c), max(c)))) for c in zip(*found)])
        text = re.sub("#", lambda _, each=spans: next(each), pattern)
        notes.append(f"- ({letters[pattern]}) {text}\n")
    return [f"({letters[re.sub(number, '#', text)]})" if text else "" for text in texts], "".join(notes)


def short_source(references):
    """Authors of the first source, without initials: "Edmans and Sinka"."""
    authors = re.split(r" \((?:\d{4}|n\.d\.)\)", references[0].removeprefix("- "))[0]
    return re.sub(r"\b[A-Z]\.[ -]?", "", authors).strip()


def write_presets(presets):
    """A row for each material, with a column for each model that has it."""
    models = list(dict.fromkeys(model for _, _, model, _ in presets))
    marks, notes = footnotes([lacks for *_, lacks in presets])
    rows = {}
    for (preset, source, model, _), mark in zip(presets, marks):
        rows.setdefault((preset, source), {})[model] = mark or "yes"
    heading = ["preset", "from", *(f"[`{model}`](/reference/models/{model}.md)" for model in models)]
    lines = [[f"`{preset}`", source, *(of.get(model, "-") for model in models)] for (preset, source), of in rows.items()]
    write("presets.md", table(heading, lines) + "\n" + notes)


def write_models(program, schema, ready):
    names = []
    rows = []
    shutil.rmtree(MODEL_PAGES, ignore_errors=True)
    used, used_of_contacts = set(), set()
    events_of = {}
    presets = []
    for line in run(program, "models").splitlines():
        name, summary = line.split(None, 1)
        names.append(name)
        rows.append([f"[`{name}`](/reference/models/{name}.md)", summary])
    for name in names:
        text = run(program, "models", name)
        sections = sections_of(text)
        summary = sections[name][0]
        definition = schema["definitions"][name]
        properties = definition["properties"]
        page = f"# Model `{name}`\n\n{summary[0].upper()}{summary[1:]}.\n\n"
        references = [f"- {line}" for line in sections.get("reference", [])]
        page += "References:\n\n" + "\n".join(references) + "\n\n" if references else ""
        page += f"Source: {sections['source'][0]}.\n\n" if "source" in sections else ""
        page += f"Equations, figures and limits of the law: {{doc}}`/theory/{name}`.\n\n"
        if "material" in properties:
            material = properties["material"]
            page += "## `[material]`\n\n"
            # The schema leaves to the reader what is required without a preset.
            required = [line.split()[0] for line in sections["[material]"] if line.endswith("; required")]
            page += key_table(material["properties"], required, ("preset",), words_of(sections["[material]"]))
            listed = [line.strip() for line in sections["[material]"] if line.startswith(" " * 29)]
            if listed:
                page += "\nA `preset` gives values of keys; keys beside it override them. With its default options, the "
                page += "model takes these materials as they are, unless the last column says what they lack:\n\n"
                split = [re.fullmatch(r'"(.*)", ([^;]*)(?:; (.*))?', item).groups("") for item in listed]
                marks, notes = footnotes([lacks for _, _, lacks in split])
                page += table(["preset", "from", "lacks"], [[f"`{a}`", b, m] for (a, b, _), m in zip(split, marks)])
                page += f"\n{notes}"
                presets += [(a, f"{short_source(references)}, {b}", name, c) for a, b, c in split]
            if "ludwik" in material["properties"]:
                ludwik = material["properties"]["ludwik"]
                page += "\nKeys of the table `ludwik`:\n\n" + key_table(ludwik["properties"], ludwik["required"])
            page += "\n"
        if name in properties and properties[name].get("properties"):
            page += f"## `[{name}]`\n\n"
            page += key_table(properties[name]["properties"], properties[name].get("required", []), (),
                              words_of(sections[f"[{name}]"])) + "\n"
        if "particle" not in properties:
            page += "## Steps\n\n"
            for key, form in steps_of(schema["definitions"][f"{name}-step"]):
                page += f"`{key}`\n\n" + key_table(form["properties"], form["required"], (), (key, *ORDER)) + "\n"
            page += "Conditions of `until`:\n\n"
            page += key_table(until_of(schema["definitions"][f"{name}-step"]), []) + "\n"
        if "configurations" in sections:
            words = sections["configurations"][0].split(", ")
            page += "Configurations: " + ", ".join(f"`{word}`" for word in words) + ". "
            if "centre" in sections:
                page += "Centre: " + ", ".join(f"`{word}`" for word in sections["centre"][0].split(", ")) + "."
            page += "\n\n"
        if "other programs" in sections:
            page += f"Other programs that compute the same test: {sections['other programs'][0]}.\n\n"
        regimes, events = terms(sections["regimes"]), terms(sections["events"])
        page += "## Regimes\n\n" + table(["regime", "meaning"], [[f"`{a}`", b] for a, b in regimes])
        page += "\n## Events\n\n" + table(["event", "meaning"], [[f"`{a}`", b] for a, b in events])
        for event, meaning in events:
            events_of.setdefault(event, []).append((name, meaning))
        page += "\n## Validity\n\n" + "\n".join(line.strip() for line in sections["validity"]) + "\n"
        if name not in ready:
            fail(f"no ready scenario shows model '{name}'")
        particle = list(dict.fromkeys(c for entry in ready[name] for c in entry[2]))
        contact = list(dict.fromkeys(c for entry in ready[name] for c in entry[3]))
        page += "\n## Columns of `history.csv`\n\n" + column_table(particle, COLUMNS, used)
        if contact:
            page += "\nFor each contact class, as in `axial.force[N]`:\n\n"
            page += column_table(contact, CONTACT_COLUMNS, used_of_contacts)
        page += "\n## Derived parameters\n\n"
        example = ready[name][0][0]
        page += f"`monograin models {name} --parameters scenarios/{example}.toml` prints\n\n```text\n"
        page += run(program, "models", name, "--parameters", ROOT / "scenarios" / f"{example}.toml")
        page += "```\n\n## Ready scenarios\n\n"
        page += "\n".join(f"- `scenarios/{entry[0]}.toml`: {entry[1]}" for entry in ready[name]) + "\n"
        write(f"{name}.md", page, MODEL_PAGES)
    for unused in [*(set(COLUMNS) - used), *(set(CONTACT_COLUMNS) - used_of_contacts)]:
        fail(f"no ready scenario has the column '{unused}', whose meaning this script knows")
    write("models.md", table(["model", "description"], rows))
    write_presets(presets)
    lines = []
    for event in sorted(events_of):
        models_of = {}
        for name, meaning in events_of[event]:
            models_of.setdefault(meaning, []).append(f"`{name}`")
        for meaning, models in models_of.items():
            lines.append([f"`{event}`", meaning, ", ".join(models)])
    write("events.md", table(["event", "meaning", "models"], lines))
    listed = []
    for name in names:
        listed += [[f"`{entry[0]}.toml`", f"`{name}`", entry[1]] for entry in ready[name]]
    write("scenarios.md", table(["file", "model", "title"], listed))
    return names


def subcommands_of(help_text):
    """Names of the commands that a help text lists."""
    block = help_text.split("Subcommands:", 1)
    return re.findall(r"^  (\S+)", block[1].split("\n\n")[0], re.MULTILINE) if len(block) == 2 else []


def write_commands(program):
    top = run(program, "--help")
    text = f"```text\n{top}```\n"
    commands = subcommands_of(top)
    if not commands:
        fail("'monograin --help' lists no subcommands")
    for command in commands:
        names = [command]
        for name in names:
            help_text = run(program, *name.split(), "--help")
            names += [f"{name} {part}" for part in subcommands_of(help_text)]
            text += f"\n## `monograin {name}`\n\n```text\n{help_text}```\n"
    write("commands.md", text)
    return commands


def entries_of(text):
    """BibTeX entries by their keys."""
    parts = re.split(r"^(?=@)", text, flags=re.MULTILINE)
    return {re.match(r"@\w+\{([^,]+),", part).group(1): part.strip() for part in parts if part.startswith("@")}


def write_references(program, commands):
    """Writes the entries of `monograin cite`, where the program has it, and those that docs/references.bib adds."""
    by_hand = entries_of((DOCS / "references.bib").read_text(encoding="utf-8"))
    printed = entries_of(run(program, "cite")) if "cite" in commands else {}
    entries = {**printed, **{key: entry for key, entry in by_hand.items() if key not in printed}}
    write("references.bib", "\n\n".join(entries.values()) + "\n")
    return f"{len(printed)} of 'monograin cite', {len(entries) - len(printed)} of docs/references.bib"


# --- measurements


def rows_of(file):
    with open(file, encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


SPACE = "\u00a0"  # keeps a number and its unit in one line


def percent(value):
    return f"{100 * float(value):.3g}{SPACE}%"


def microseconds(seconds):
    micro = 1e6 * float(seconds)
    return f"{micro:.3g}{SPACE}µs" if micro < 999.5 else f"{micro / 1000:.3g}{SPACE}ms"


def tenths(value):
    """A share in per cent; a hyphen for what was not measured."""
    return "-" if value == "nan" else f"{100 * float(value):.1f}"


def largest_percent(values):
    """The largest share in per cent; a hyphen if none was measured."""
    measured = [float(value) for value in values if value != "nan"]
    return f"{100 * max(measured):.0f}" if measured else "-"


def write_distance_of_cel(rows):
    """Largest and root mean square error of every case that model cel was held against."""
    quantities = ("axial force", "lateral force", "axial area", "lateral area")
    cases = {}
    for row in rows:
        group, _, scene = row["table"].partition(": ")
        case, _, law = row["case"].rpartition(": ")
        if group in ("Fitted", "Validation", "Held out") and law == "cel":
            # Six walls that move alike have one force.
            quantity = row["quantity"] if " " in row["quantity"] else f"axial {row['quantity']}"
            cases.setdefault((group, scene, case), {})[quantity] = row
    lines = []
    for (group, scene, case), found in cases.items():
        both = [f"{tenths(found[q]['largest'])} / {tenths(found[q]['rms'])}" if q in found else "" for q in quantities]
        back = [tenths(found[q]["unloading"]) if q in found else "" for q in quantities[:2]]
        lines.append([group.lower(), f"{scene}, {case}", *both, *back])
    write("cel-distance.md", table(["set", "case", *quantities, "unloading, axial", "unloading, lateral"], lines))


LEAST_COVERAGE = 0.5  # share of a band from which on an error stands for it


def write_laws(program, rows):
    """One row for each law of walls: cost, distance from finite elements by strain, domain."""
    times = {row["scene"]: microseconds(row["fastest[s]"]) for row in rows_of(ROOT / "plots" / "laws-cost.csv")}
    strains = {}
    for row in rows:
        group, _, scene = row["table"].partition(": ")
        if group == "By strain":
            material, _, law = row["case"].rpartition(": ")
            column = f"{scene}, {row['quantity']}" if row["quantity"] else scene
            strains.setdefault((law, material), {}).setdefault(column, []).append(row)
    columns = list(dict.fromkeys(column for found in strains.values() for column in found))
    lines, domains = [], []
    for law in MODEL_WORDS:
        domain = sections_of(run(program, "models", law))["validity"][0].strip().removeprefix("- ")
        rounded = re.sub(r"\d+\.\d{2,}", lambda found: f"{float(f'{float(found[0]):.3g}'):g}", domain)
        domains.append([f"`{law}`", rounded.replace("nu^2", "ν²")])
        for (name, material), found in strains.items():
            if name != law:
                continue
            cells = []
            for column in columns:
                measured = found.get(column, [])
                loading = [row["largest"] for row in measured if float(row["coverage"]) >= LEAST_COVERAGE]
                cells += [largest_percent(loading), largest_percent(row["unloading"] for row in measured)]
            lines.append([f"`{law}`", material, *cells, times.get(law)])
    missing = set(MODEL_WORDS) - {law for law, _ in strains} | set(MODEL_WORDS) ^ set(times)
    if missing:
        fail(f"plots/laws-fe.csv or plots/laws-cost.csv does not have {', '.join(sorted(missing))}")
    heading = [f"{column}: {part}" for column in columns for part in ("load", "back")]
    write("laws.md", table(["law", "material", *heading, "time"], lines) + "\n" + table(["law", "domain"], domains))


def write_measurements(program):
    """Tables from the committed measurements: distance from finite elements, time and error of each scene."""
    rows = rows_of(ROOT / "plots" / "laws-fe.csv")
    write_distance_of_cel(rows)
    write_laws(program, rows)
    last = {}
    for row in rows:
        if row["peak_error"] != "nan":
            last[row["table"], row["case"]] = row  # rows of a case go on to larger displacements
    by_scene = {}
    for (scene, case), row in last.items():
        material, _, law = case.rpartition(": ")
        by_scene.setdefault(scene, []).append(
            [material, re.sub(rf"\b({'|'.join(MODEL_WORDS)})\b", r"`\1`", law, count=1), f"{float(row['reversal']):.3g}",
             percent(row["peak_error"]), f"{float(row['area_error']):.3g}", percent(row["coverage"])])
    text = ""
    for scene, lines in by_scene.items():
        text += f"\n**{scene}**\n\n"
        heading = ["case", "law", "up to δ/R0", "peak error", "area error", "covered"]
        if all(line[0] == "" for line in lines):
            heading, lines = heading[1:], [line[1:] for line in lines]
        text += table(heading, lines)
    write("distance.md", text)

    measured = {}
    for row in rows_of(ROOT / "plots" / "bench.csv"):
        measured.setdefault(row["scene"], []).append(row)
    with open(ROOT / "scenarios" / "bench" / "scenes.toml", "rb") as stream:
        titles = {scene["name"]: scene["title"] for scene in tomllib.load(stream)["scene"] if "name" in scene}
    for file in (ROOT / "scenarios").glob("*.toml"):
        titles.setdefault(file.stem, tomllib.loads(file.read_text(encoding="utf-8"))["title"])
    lines = []
    for scene, rows in measured.items():
        def at(integrator, scene_rows=rows):
            return next(row for row in scene_rows if row["integrator"] == integrator and float(row["rtol"]) == 1e-8)

        auto, bdf = at("auto"), at("cvode-bdf")
        ratio = float(bdf["fastest[s]"]) / float(auto["fastest[s]"])
        lines.append([f"`{scene}`", titles[scene], microseconds(auto["fastest[s]"]), f"{float(auto['curve_error']):.1g}",
                      microseconds(bdf["fastest[s]"]), f"{float(bdf['curve_error']):.1g}", f"{ratio:.3g}"])
    write("cost.md", table(["scene", "title", "`auto`", "its error", "`cvode-bdf`", "its error", "time ratio"], lines))
    write_equal_errors()


USUAL_RATIO = 1.2  # of the time of auto to that of the fastest method


def write_equal_errors():
    """Columns of the table "auto" of plots/bench.md, and the largest advantage of another method in it."""
    text = (ROOT / "plots" / "bench.md").read_text(encoding="utf-8").split("## `auto`")[1].split("\n## ")[0]
    rows = [[part.strip() for part in line.strip("|\n").split("|")] for line in text.splitlines() if line.startswith("|")]
    heading, rows = rows[0], rows[2:]
    errors = {error: heading.index(f"at {error}") for error in ("1e-04", "1e-06", "1e-08", "1e-10")}
    slow = {row[0]: max(float(row[at]) for at in errors.values()) for row in rows}
    usual = max(ratio for ratio in slow.values() if ratio <= USUAL_RATIO)
    exceptions = [f"{ratio:.3g} times in `{scene}`" for scene, ratio in slow.items() if ratio > USUAL_RATIO]
    but = f", but up to {' and '.join(exceptions)}, at the largest error" if exceptions else ""
    shown = ["scene", "is", "bdf at 1e-04", "bdf at 1e-08", "bdf at its own"]
    lines = [[f"`{row[0]}`", *(row[heading.index(name)] for name in shown[1:])] for row in rows]
    write("equal-errors.md",
          f"At errors of 1e-4, 1e-6, 1e-8 and 1e-10 the time of `auto` is at most {usual:.3g} times that of the fastest other "
          f"method{but}. The table gives the time of `cvode-bdf`, the standard code for stiff equations, over that of `auto`:\n\n"
          + table(["scene", "`auto` is", "at 1e-4", "at 1e-8", "at the error of `auto`"], lines))


def narrow(heading, rows):
    """Heading and rows of a table of the atlas that fit on a page.

    Leaves out ratios, which follow from other columns, and empty columns. The law that ends a case, and the quantity that
    begins several headings, have columns of their own.
    """
    quantities = list(dict.fromkeys(name.split(": ")[0] for name in heading if ": " in name))
    if quantities:
        plain = [k for k, name in enumerate(heading) if ": " not in name]
        parts = list(dict.fromkeys(name.split(": ")[1] for name in heading if ": " in name))
        at = {name: k for k, name in enumerate(heading)}
        rows = [[*(row[k] for k in plain), q, *(row[at[f"{q}: {p}"]] if f"{q}: {p}" in at else "" for p in parts)]
                for row in rows for q in quantities]
        heading = [*(heading[k] for k in plain), "quantity", *parts]
    cases = [re.fullmatch(rf"(?:(.*?):? )??((?:{'|'.join(MODEL_WORDS)})\b.*)", row[0]) for row in rows]
    if heading[0] == "case" and all(cases):
        heading = ["case", "law", *heading[1:]]
        rows = [[*found.groups(""), *row[1:]] for found, row in zip(cases, rows)]
    kept = [k for k, name in enumerate(heading)
            if name not in ("slope ratio", "residual ratio") and any(row[k] not in ("", "-") for row in rows)]
    return [heading[k] for k in kept], [[row[k] for k in kept] for row in rows]


def with_narrow_tables(text):
    """A page of plots/ with its tables of errors made narrower."""
    def narrowed(found):
        cells = [[part.strip() for part in line.strip("|").split("|")] for line in found[0].splitlines()]
        return table(*narrow(cells[0], cells[2:]))

    return re.sub(r"^\| case .*\n(?:\|.*\n)+", narrowed, text, flags=re.MULTILINE).replace(
        "residual x where y vanishes, and both over those\nof the reference.",
        "residual x where y vanishes, and both of the\nreference.")


def write_tables():
    """A page for each table that the atlas and the bench have left in plots/."""
    shutil.rmtree(TABLES, ignore_errors=True)
    for file in sorted((ROOT / "plots").glob("*.md")):
        if file.name != "README.md":
            write(file.name, with_narrow_tables(file.read_text(encoding="utf-8")), TABLES)


def draw_comparison(program, scratch):
    """The figure of two materials in "Getting started"."""
    softer = scratch / "softer"
    run(program, "run", ROOT / "scenarios" / "die.toml", "--set", "material.yield_stress=30 MPa", "-o", softer, "--quiet")
    run(program, "plot", scratch / "die", softer, "-o", scratch / "both.svg")
    shutil.copy(scratch / "both.svg", GENERATED / "figures" / "both.svg")


def block_of(page, name):
    """A block of a page that its mark calls a file."""
    text = (DOCS / page).read_text(encoding="utf-8")
    found = re.search(rf"<!-- test: file {re.escape(name)} -->\n```\w+\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return found.group(1) if found else fail(f"docs/{page} has no block for the file {name}")


def draw_own_figure(program, scratch):
    """The figure that the definition in "Getting started" draws."""
    (scratch / "paper").mkdir()
    write("mine.toml", block_of("getting-started.md", "mine.toml"), scratch)
    definition = block_of("getting-started.md", "paper/yield.toml").replace('format = "pdf"', 'format = "svg"')
    write("yield.toml", definition, scratch / "paper")
    run(program, "atlas", "yield", "--plots", scratch / "paper")
    shutil.copy(scratch / "paper" / "yield.svg", GENERATED / "figures" / "yield.svg")


def draw_wedge(program, scratch):
    """The figure of the scenario in "Set up your own walls"."""
    write("wedge.toml", block_of("howto/own-walls.md", "wedge.toml"), scratch)
    run(program, "run", scratch / "wedge.toml", "--plot", "--quiet", "-o", scratch / "wedge")
    shutil.copy(scratch / "wedge" / "figure.svg", GENERATED / "figures" / "wedge.svg")


def draw_bands(program, scratch):
    page = (ROOT / "docs" / "howto" / "sweeps.md").read_text(encoding="utf-8")
    text = page.split("<!-- test: file curves.toml -->")[1].split("```toml\n")[1].split("```")[0]
    sweep = scratch / "curves.toml"
    sweep.write_text(text.replace("scenarios/die.toml", str(ROOT / "scenarios" / "die.toml")), encoding="utf-8")
    run(program, "sweep", sweep, "-o", scratch / "bands")
    shutil.copy(scratch / "bands" / "bands.svg", GENERATED / "figures" / "bands.svg")


def draw_calibrations(program, scratch):
    ready = ROOT / "scenarios" / "calibrate"
    run(program, "calibrate", ready / "uniaxial.toml", "-o", scratch / "calibration")
    shutil.copy(scratch / "calibration" / "figure.svg", GENERATED / "figures" / "calibration.svg")
    run(program, "calibrate", ready / "cel.toml", ready / "cel-by-mdr.toml", "-o", scratch / "laws")
    shutil.copy(scratch / "laws" / "comparison.svg", GENERATED / "figures" / "calibration-laws.svg")


def draw_design(program, scratch):
    run(program, "design", ROOT / "scenarios" / "design" / "uniaxial.toml", "-o", scratch / "expected")
    shutil.copy(scratch / "expected" / "figure.svg", GENERATED / "figures" / "design.svg")


# --- examples, and the interfaces for programs


def write_examples():
    """Parts that show the programs of examples/cpp, each saying so where its program is missing, and a copy of the Python
    examples."""
    folder = ROOT / "examples" / "cpp"
    for name in CPP_EXAMPLES:
        file = folder / f"{name}.cpp"
        if file.is_file():
            text = f"`examples/cpp/{name}.cpp`:\n\n```{{literalinclude}} /../examples/cpp/{name}.cpp\n:language: cpp\n```\n"
        elif folder.is_dir():
            fail(f"pages show examples/cpp/{name}.cpp, which is not there")
        else:
            text = "```{note}\nThis version of monograin comes without its C++ examples.\n```\n"
        write(f"example-{name}.md", text)
    # Sphinx runs the scripts of examples/python where they lie: what they leave stays beside a copy.
    copies = GENERATED / "python-examples"
    shutil.rmtree(copies, ignore_errors=True)
    shutil.copytree(ROOT / "examples" / "python", copies)


def first_sentence(docstring):
    """The first sentence of a docstring in Markdown: roles of Sphinx become code."""
    paragraph = " ".join(inspect.cleandoc(docstring).split("\n\n")[0].split())
    return re.split(r"(?<=[.?]) ", re.sub(r":\w+:`~?([^`]+)`", r"`\1`", paragraph))[0].rstrip(".:")


def toctree(pages):
    return "```{toctree}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"


def write_api_page(name, text):
    page = API_PAGES / f"{name}.md"
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(text, encoding="utf-8")


def write_python_page(name, title, directives, rest=""):
    text = "\n".join(directives)
    write_api_page(f"python/{name}", f"# {title}\n\n```{{eval-rst}}\n{text}```\n{rest}")


def write_python_api():
    """A page for each module in which public names are defined, a page for each law, and a list of the names."""
    if importlib.util.find_spec("monograin") is None:
        fail("this interpreter cannot import monograin; run tools/docs, which builds the package, or install it")
    package = importlib.import_module("monograin")
    text = ""
    listed = {"__version__", "laws"}
    for name in PYTHON_MODULES:
        module = importlib.import_module(f"monograin.{name}")
        title = first_sentence(module.__doc__).partition(":")[0]
        own = [key for key, value in vars(module).items()
               if key in package.__all__ and value.__module__ == module.__name__]
        listed.update(own)
        kinds = [("class", "   :members:\n") if isinstance(getattr(module, key), type) else ("function", "")
                 for key in own]
        write_python_page(name, title, [f".. auto{kind}:: monograin.{key}\n{options}"
                                        for key, (kind, options) in zip(own, kinds)])
        rows = [[f"{{py:obj}}`~monograin.{key}`", first_sentence(getattr(module, key).__doc__)] for key in own]
        text += f"## {title}\n\n" + table(["name", "purpose"], rows) + "\n"
    if listed != set(package.__all__):
        fail(f"no module of PYTHON_MODULES defines {', '.join(set(package.__all__) - listed)}")
    title, _, description = inspect.cleandoc(package.laws.__doc__).partition("\n\n")
    laws = [f"laws.{name}" for name in sorted(package.laws.__all__, key=lambda law: description.index(f"laws.{law}`"))]
    write_python_page("laws", title.rstrip("."), [".. module:: monograin.laws\n\n", description, "\n"],
                      "\n" + toctree(laws))
    for law in laws:
        directive = f".. automodule:: monograin.{law}\n   :members:\n   :ignore-module-all:\n"
        write_python_page(law, f"`{law}`", [directive])
    rows = [[f"{{py:mod}}`~monograin.{law}`", first_sentence(importlib.import_module(f"monograin.{law}").__doc__)]
            for law in laws]
    text += "## [Contact laws in closed form](/reference/api/python/laws.md)\n\n" + table(["module", "law"], rows)
    text += "\n"
    write("python-api.md", text + toctree([f"api/python/{name}" for name in (*PYTHON_MODULES, "laws")]))
    return f"{len(PYTHON_MODULES)} modules and {len(laws)} laws of {pathlib.Path(package.__file__).parent}"


def declarations_of(xml, header):
    """A directive of breathe for everything that a header declares."""
    index = ElementTree.parse(xml / "index.xml")
    kinds = {compound.get("refid"): compound.get("kind") for compound in index.iter("compound")}
    for refid, kind in kinds.items():
        if kind != "file":
            continue
        file = ElementTree.parse(xml / f"{refid}.xml").find("compounddef")
        if file.find("location").get("file") == header:
            break
    else:
        fail(f"doxygen has not read {header}")
    # Namespaces by the file of their description.
    namespaces = {name.text: compound.get("refid") for compound in index.iter("compound")
                  for name in [compound.find("name")] if compound.get("kind") == "namespace"}
    spaces = sorted({inner.text.rpartition("::")[0] for inner in file.findall("innerclass")} & set(namespaces))
    parts = [f"Classes are those of namespace {' and '.join(f'`{space}`' for space in spaces)}.\n\n"] if spaces else []
    for inner in file.findall("innerclass"):
        # A mere declaration: the definition stands in another file, or nowhere. A class within a class is a member.
        if inner.get("refid") in kinds and inner.text.rpartition("::")[0] in namespaces:
            own = ElementTree.parse(xml / f"{inner.get('refid')}.xml").find("compounddef")
            if own.find("location").get("bodyfile") == header or own.find("location").get("file") == header:
                kind = kinds[inner.get("refid")]
                parts.append(f"```{{doxygen{kind}}} {inner.text}\n:members:\n:undoc-members:\n```\n\n")
    for scope, refid in namespaces.items():
        namespace = ElementTree.parse(xml / f"{refid}.xml").find("compounddef")
        members = list(namespace.iter("memberdef"))
        functions = [member.findtext("name") for member in members if member.get("kind") == "function"]
        for member in members:
            if member.find("location").get("file") != header:
                continue
            kind, name = member.get("kind"), member.findtext("name")
            arguments = member.findtext("argsstring") if kind == "function" and functions.count(name) > 1 else ""
            arguments = re.sub(r"\)[^)]*$", ")", arguments)
            parts.append(f"```{{doxygen{kind}}} {scope}::{name}{arguments}\n```\n\n")
    return parts


def write_cpp_api():
    folder = ROOT / "include" / "monograin"
    headers = [folder / f"{name}.hpp" for name in CPP_HEADERS]
    if set(headers) != set(folder.glob("*.hpp")):
        fail(f"CPP_HEADERS are not the headers of {folder}")
    output = GENERATED / "doxygen"
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    settings = {
        "PROJECT_NAME": "monograin",
        "INPUT": folder,
        "RECURSIVE": "NO",
        "FILE_PATTERNS": "*.hpp",
        "OUTPUT_DIRECTORY": output,
        "GENERATE_HTML": "NO",
        "GENERATE_LATEX": "NO",
        "GENERATE_XML": "YES",
        "XML_PROGRAMLISTING": "NO",
        "STRIP_FROM_PATH": ROOT / "include",
        "QUIET": "YES",
        "WARN_IF_UNDOCUMENTED": "NO",
        "EXTRACT_ALL": "YES",
        "MACRO_EXPANSION": "YES",
    }
    (output / "Doxyfile").write_text("\n".join(f"{key} = {value}" for key, value in settings.items()) + "\n",
                                     encoding="utf-8")
    run("doxygen", output / "Doxyfile")
    rows = []
    for header in headers:
        name = header.relative_to(ROOT / "include").as_posix()
        # The comment at the top of the header, which doxygen does not take for that of the file.
        comment, _, _ = header.read_text(encoding="utf-8").partition("#pragma")
        description = " ".join(comment.replace("///", "").split())
        text = f"# `{header.name}`\n\n`#include <{name}>`\n\n{description}\n\n"
        write_api_page(f"cpp/{header.stem}", text + "".join(declarations_of(output / "xml", name)))
        rows.append([f"[`{header.name}`](/reference/api/cpp/{header.stem}.md)", first_sentence(description)])
    pages = [f"api/cpp/{header.stem}" for header in headers]
    write("cpp-api.md", table(["header", "content"], rows) + "\n" + toctree(pages))
    return f"{len(headers)} headers"


def main():
    parser = argparse.ArgumentParser(description="Writes the parts of the documentation that the program knows.")
    parser.add_argument("--program", help="monograin; default: that of build/demo or build/release")
    program = find_program(parser.parse_args().program)
    GENERATED.mkdir(parents=True, exist_ok=True)
    schema = json.loads(run(program, "schema"))
    with tempfile.TemporaryDirectory() as scratch:
        ready = run_ready_scenarios(program, pathlib.Path(scratch))
        draw_calibrations(program, pathlib.Path(scratch))
        draw_bands(program, pathlib.Path(scratch))
        draw_design(program, pathlib.Path(scratch))
        draw_comparison(program, pathlib.Path(scratch))
        draw_own_figure(program, pathlib.Path(scratch))
        draw_wedge(program, pathlib.Path(scratch))
    models = write_models(program, schema, ready)
    write_language(schema)
    write_limits()
    write_measurements(program)
    write_tables()
    commands = write_commands(program)
    runs = sum(len(entries) for entries in ready.values())
    print(f"docs/generate.py: {len(models)} models, {runs} ready scenarios run, {len(commands)} commands")
    write_examples()
    print(f"docs/generate.py: references: {write_references(program, commands)}")
    shutil.rmtree(API_PAGES, ignore_errors=True)
    print(f"docs/generate.py: Python interface: {write_python_api()}")
    print(f"docs/generate.py: C++ interface: {write_cpp_api()}")


if __name__ == "__main__":
    main()

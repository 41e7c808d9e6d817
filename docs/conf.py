"""Configuration of the documentation site. `tools/docs` builds it."""

import ast
import pathlib
import re

from docutils import nodes
from matplotlib.figure import Figure
from sphinx.ext import napoleon
from sphinx_gallery.scrapers import figure_rst

DOCS = pathlib.Path(__file__).resolve().parent
ROOT = DOCS.parent
GENERATED = DOCS / "generated"

cmake_project = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
project = "monograin"
release = re.search(r"project\(monograin VERSION ([0-9.]+)", cmake_project).group(1)
version = release
author = "the authors of monograin"
html_show_copyright = False

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinxcontrib.bibtex",
    "sphinx_copybutton",
    "breathe",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    # Parts of pages, and what they are made from.
    "generated/*.md",
    "generated/python-examples",
    "howto/python-examples/sg_execution_times.rst",
]
language = "en"
nitpicky = True
# Names of the standard library and of numpy, whose own sites are not asked.
nitpick_ignore_regex = [
    (r"cpp:.*", r"(std|fmt|Eigen)(::.*)?"),
    (r"cpp:.*", r"(size_t|uint\d+_t|int\d+_t)"),
    (r"py:.*", r"(np|numpy|pandas|matplotlib|os|pathlib|collections|typing|npt)\..*"),
    # Types that are no part of the interface, and sentences that begin as a type does.
    (r"py:.*", r"(_core\..*|Path|[a-z_]+|\w+ .*)"),
    (r"py:.*", r"(optional|array_like|callable|scalar|shape|default|ndarray|ArrayLike|NDArray|DataFrame).*"),
]

# Types of the headers that are only declared: their definitions are not part of the interface.
nitpick_ignore = [("cpp:identifier", "monograin"), ("cpp:identifier", "monograin::study")] + [
    ("cpp:identifier", name)
    for header in (ROOT / "include").rglob("*.hpp")
    for name in re.findall(r"^(?:class|struct) (\w+);", header.read_text(encoding="utf-8"), re.MULTILINE)
]

# --- Markdown
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False

# --- formulas: a copy of Debian's MathJax, so that the pages need no network
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
mathjax2_config = {"messageStyle": "none", "tex2jax": {"processClass": "math", "ignoreClass": "document"}}

# --- references
bibtex_bibfiles = ["generated/references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

# --- code
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
breathe_projects = {"monograin": str(GENERATED / "doxygen" / "xml")}
breathe_default_project = "monograin"
breathe_show_include = False
breathe_domain_by_extension = {"hpp": "cpp"}
autodoc_member_order = "bysource"
napoleon_use_ivar = True
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented_params"
# The union of all that numpy makes an array of, by its name.
autodoc_type_aliases = {"ArrayLike": "ArrayLike"}

# --- Python examples: a page and a notebook of each script, which runs when the site is built


def figures_of_block(_block, variables, gallery):
    """Saves the figures that a block of a script has made; pyplot knows none of them. The script describes them."""
    script = ast.parse(pathlib.Path(variables["src_file"]).read_text(encoding="utf-8"))
    text = " ".join(ast.get_docstring(script).split("\n\n")[1].replace("`", "").split())
    described = re.split(r"(?<=[.?]) ", text)[0]
    shown = variables.setdefault("shown_figures", [])
    paths = []
    for value in list(variables["example_globals"].values()):
        if isinstance(value, Figure) and value not in shown:
            shown.append(value)
            paths.append(next(variables["image_path_iterator"]))
            value.savefig(paths[-1], dpi=150)
    return figure_rst(paths, gallery["src_dir"], described)


sphinx_gallery_conf = {
    "examples_dirs": "generated/python-examples",
    "gallery_dirs": "howto/python-examples",
    "filename_pattern": r"\.py$",
    "abort_on_example_error": True,
    "run_stale_examples": True,
    "image_scrapers": (figures_of_block,),
    "capture_repr": (),
    # Jupyter's own arguments are none of the script's.
    "first_notebook_cell": "%matplotlib inline\nimport sys\n\nsys.argv = sys.argv[:1]",
    "download_all_examples": False,
    "show_signature": False,
}

# --- looks
html_theme = "furo"
html_title = f"monograin {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
pygments_style = "default"
pygments_dark_style = "github-dark"


process_docstring = napoleon._process_docstring


def process_docstring_of_property(app, what, *rest):
    """Reads a property's docstring as that of a method: "Curves: a table" does not begin with a type there."""
    process_docstring(app, "method" if what in ("attribute", "property") else what, *rest)


napoleon._process_docstring = process_docstring_of_property


def skip_fields(_app, _what, _name, member, skip, _options):
    """Leaves out fields of named tuples, which the text of their class describes."""
    return skip or type(member).__name__ == "_tuplegetter"


def hide_constructor(_app, _what, _name, _member, _options, signature, returns):
    """Hides the arguments of a class that the package alone makes, from an object of its core."""
    return ("", returns) if signature and signature.startswith("(core") else None


def link_tables(_app, _name, source):
    """Links to tables of plots/ lead to their pages (docs/generate.py writes these)."""
    source[0] = re.sub(r"\]\((?:\.\./)+plots/([\w-]+)\.md\)", r"](/tables/\1.md)", source[0])


def link_figures(app, doctree, docname):
    """Makes each figure a link to its file, which a phone shows larger."""
    root = "../" * docname.count("/")
    for figure in doctree.findall(nodes.figure):
        image = figure[0]
        if isinstance(image, nodes.image) and image["uri"] in app.env.images:
            name = app.env.images[image["uri"]][1]
            figure.replace(image, nodes.reference("", "", image, refuri=f"{root}_images/{name}"))


def setup(app):
    app.connect("source-read", link_tables)
    app.connect("doctree-resolved", link_figures)
    app.connect("autodoc-skip-member", skip_fields)
    app.connect("autodoc-process-signature", hide_constructor)

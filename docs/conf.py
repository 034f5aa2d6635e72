"""Sphinx settings."""

from collections.abc import Mapping
from importlib.metadata import version as installed_version

from beltdyn.results import COORDINATES, VARIABLES, Variable

project = "beltdyn"
author = "The beltdyn developers"
copyright = "2026, the beltdyn developers"
release = installed_version("beltdyn")
version = release

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
]
myst_enable_extensions = ["amsmath", "colon_fence", "dollarmath", "substitution"]
myst_heading_anchors = 3


def table(variables: Mapping[str, Variable]) -> str:
    """Give the variables of a result as a table in Markdown."""
    rows = [
        f"| `{name}` | {variable.long_name} | {variable.units if variable.dtype != 'str' else 'text'} "
        f"| {', '.join(variable.dims)} |"
        for name, variable in variables.items()
    ]
    return "\n".join(["| name | meaning | unit | dimensions |", "|---|---|---|---|", *rows])


myst_substitutions = {"variables": table(VARIABLES), "coordinates": table(COORDINATES)}
napoleon_google_docstring = False
autodoc_typehints = "description"
templates_path = ["_templates"]
exclude_patterns = ["_build"]

html_theme = "pydata_sphinx_theme"
html_title = "beltdyn"
html_static_path = ["_static"]

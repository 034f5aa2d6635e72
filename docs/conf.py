"""Sphinx settings."""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "_extensions"))

project = "beltdyn"
author = "The beltdyn developers"
copyright = "2026, the beltdyn developers"
release = installed_version("beltdyn")
version = release

extensions = [
    "mathml",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
]
myst_enable_extensions = ["amsmath", "colon_fence", "dollarmath"]
myst_heading_anchors = 3
napoleon_google_docstring = False
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
html_math_renderer = "mathml"
templates_path = ["_templates"]
exclude_patterns = ["_build"]

html_theme = "pydata_sphinx_theme"
html_title = "beltdyn"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_theme_options = {
    "header_links_before_dropdown": 6,
    "navigation_with_keys": True,
    "show_toc_level": 2,
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_sidebars = {page: [] for page in ("index", "tutorial")}  # without pages below them


def describe_record(app: object, what: str, name: str, kind: object, options: object, lines: list[str]) -> None:
    """Name the fields of a record type, whose docstring is that of all NumPy types."""
    if isinstance(kind, np.dtype):
        lines[:] = [f"A NumPy record type with the fields {', '.join(kind.names or ())}."]


_COLON = "\ue000"


def hide_colons(app: object, what: str, name: str, kind: object, options: object, lines: list[str]) -> None:
    """Keep napoleon from taking what stands before a colon for the type of a field."""
    if what in ("attribute", "property"):
        lines[:] = [line.replace(": ", f"{_COLON} ") for line in lines]


def show_colons(app: object, what: str, name: str, kind: object, options: object, lines: list[str]) -> None:
    """Bring them back."""
    lines[:] = [line.replace(_COLON, ":") for line in lines]


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", describe_record)
    app.connect("autodoc-process-docstring", hide_colons, priority=400)
    app.connect("autodoc-process-docstring", show_colons, priority=600)

"""Sphinx settings."""

from importlib.metadata import version as installed_version

project = "beltdyn"
author = "The beltdyn developers"
copyright = "2026, the beltdyn developers"
release = installed_version("beltdyn")
version = release

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx.ext.napoleon"]
myst_enable_extensions = ["amsmath", "colon_fence", "dollarmath"]
myst_heading_anchors = 3
napoleon_google_docstring = False
autodoc_typehints = "description"
exclude_patterns = ["_build"]

html_theme = "pydata_sphinx_theme"
html_title = "beltdyn"

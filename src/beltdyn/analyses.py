"""Analyses by name: each is a function in a file of its own, a name of the package and a command."""

from collections.abc import Callable
from importlib import import_module
from typing import Any, NamedTuple


class Analysis(NamedTuple):
    """Where an analysis is found, without importing it.

    Attributes
    ----------
    name : str
        Name of the function, of ``beltdyn.NAME``, of the command and of the kind of its results.
    module : str
        Module that holds the function.
    purpose : str
        What it tells, in one line for the help of the command line.
    """

    name: str
    module: str
    purpose: str

    @property
    def function(self) -> Callable[..., Any]:
        """The function ``f(drive, *, ...) -> beltdyn.results.Result``."""
        function: Callable[..., Any] = getattr(import_module(self.module), self.name)
        return function


_ALL: tuple[Analysis, ...] = (
    # one line for each
)

ANALYSES = {analysis.name: analysis for analysis in _ALL}
"""All analyses by name, but for those over time and at rest, whose commands do more."""

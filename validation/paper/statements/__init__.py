"""The paper: one module for each part, with its cases and its statements.

A module has two functions: ``cases() -> dict[str, Drive]`` names what is to be run, and
``section(runs) -> Section`` judges the results. A third, ``timed(runs) -> list[str]``, names runs whose computing time
it compares: these run again, in turns.  `SECTIONS` lists the modules in the order of the page.
"""

from collections.abc import Mapping
from typing import Protocol

from beltdyn.model import Drive
from validation.paper.runs import Runs
from validation.paper.statement import Section
from validation.paper.statements import (
    beam_and_joint,
    contact_forces,
    creep_rate,
    element,
    energy,
    friction_law,
    integration_points,
    integrators,
    mesh,
    more_pulleys,
    other_models,
    released,
    slip_and_stick,
    small_pulley,
    stiffness,
)


class Part(Protocol):
    """A module of this package."""

    __name__: str

    def cases(self) -> Mapping[str, Drive]:
        """Name -> what is to be run; a name that occurs in several modules stands for the same drive."""

    def section(self, runs: Runs) -> Section:
        """What becomes of the statements."""


SECTIONS: tuple[Part, ...] = (
    element,
    friction_law,
    slip_and_stick,
    integrators,
    released,
    mesh,
    stiffness,
    creep_rate,
    contact_forces,
    integration_points,
    more_pulleys,
    small_pulley,
    other_models,
    beam_and_joint,
    energy,
)
"""The parts of the page."""

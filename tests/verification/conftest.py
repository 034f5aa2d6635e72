"""Belts and elements to verify."""

from collections.abc import Callable, Sequence
from importlib.resources import files

import numpy as np
import pytest
from hypothesis import settings

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.ancf import ANCF
from beltdyn.elements.ancf.elastic_force import element_energy, element_force
from beltdyn.elements.ancf.element import Ancf
from beltdyn.model import Belt, Drive, loads
from beltdyn.quadrature import gauss_points
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import State, at_rest, belt_section

settings.register_profile("patient", deadline=None)  # a kernel is compiled at its first call
settings.load_profile("patient")

SECTION_HELD = [(0, 0), (0, 1), (0, 4), (0, 5)]
"""A clamp holds the place and the section r_y; the tangent r_x is free to stretch and to shear against it."""


@pytest.fixture(scope="session")
def drive() -> Drive:
    """The paper's drive."""
    drive = loads(files("beltdyn").joinpath("examples", "two_pulley.toml").read_text(encoding="utf-8"))
    return drive.replace(belt=drive.belt.replace(shear_correction=13 / 15.3))


@pytest.fixture(scope="session")
def belt(drive: Drive) -> Belt:
    """The paper's belt (Table 1)."""
    return drive.belt


@pytest.fixture(scope="session")
def element_length(belt: Belt) -> float:
    return belt.given_length / belt.given_elements


@pytest.fixture(scope="session")
def unloaded(element_length: float) -> FloatArray:
    """Coordinates of a straight element along the x axis."""
    return np.array([0, 0, 1, 0, 0, 1, element_length, 0, 1, 0, 0, 1], dtype=float)


@pytest.fixture(scope="session")
def evaluate() -> Callable[[Belt, FloatArray], tuple[float, FloatArray, FloatArray]]:
    """Energy, its gradient and its tangent for one element of a belt."""

    def values(belt: Belt, e: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        section, length = belt_section(belt), belt.given_length / belt.given_elements
        element, work = Ancf(section, gauss_points(belt.quadrature_points)), blank(ANCF.workspace)
        element_force(element, e, length, True, work)
        return element_energy(element, e, length), work.gradient, work.tangent

    return values


@pytest.fixture(scope="session")
def make_cantilever() -> Callable[..., tuple[Belt, System]]:
    """A cantilever of 1 m, loaded at its tip; only the ratios of its numbers matter."""

    def make(
        thickness: float,
        elements: int,
        *,
        force: float = 0.0,
        moment: float = 0.0,
        held: Sequence[tuple[int, int]] = SECTION_HELD,
    ) -> tuple[Belt, System]:
        """Load by force L^2 / EI and moment L / EI."""
        belt = Belt(
            length=1.0,
            width=0.01,
            thickness=thickness,
            density=1000.0,
            youngs_modulus=1e8,
            poissons_ratio=0.3,
            shear_correction=13 / 15.3,
            elements=elements,
        )
        stiffness = belt.bending_stiffness
        return belt, belt_system(
            belt,
            closure="open",
            fixed=held,
            forces=[(-1, (0.0, force * stiffness))],
            moments=[(-1, moment * stiffness)],
        )

    return make


@pytest.fixture(scope="session")
def along() -> Callable[[System, FloatArray, FloatArray], State]:
    """A belt at rest with its nodes at given places, shape (N, 2), and its tangents at given angles, shape (N,)."""

    def state(system: System, places: FloatArray, angles: FloatArray) -> State:
        tangent = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
        return at_rest(system, np.hstack([places, tangent, normal]))

    return state

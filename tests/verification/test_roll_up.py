"""Verified: a cantilever rolled into a full circle by the tip moment M = 2 pi EI / L.

Against: pure bending in closed form, and the circle of a thin beam (Euler).  In pure bending the metric G = |r_x|^2 and
the turning theta are uniform, and Eqs. 14 and 15 leave

    psi(G, theta) = EA/8 (G-1)^2 + EI/2 (G theta^2 + (G-1) theta^2 / 2) + E I4/8 theta^4.

psi - M theta is stationary at G = 1 - 3 EI theta^2 / EA, a centerline that contracts by (h theta)^2 / 8.

The order to expect is 4 = 2 (3 + 1 - 2), that of nodal values by cubics in an energy of second derivatives.
"""

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.state import State, belt_section, straight

Cantilever = Callable[..., tuple[Belt, System]]
FULL_CIRCLE = 2.0 * pi
MESHES = [4, 8, 16, 32]


def pure_bending(belt: Belt, moment: float) -> tuple[float, float]:
    """Metric G and turning theta (1/m) under a moment, N m."""
    section = belt_section(belt)

    def metric(turning: float) -> float:
        return 1.0 - 3.0 * section.bending / section.axial * turning**2

    def excess_moment(turning: float) -> float:
        bending = section.bending * (1.5 * metric(turning) - 0.5) * turning
        return bending + 0.5 * section.quartic * turning**3 - moment

    turning = brentq(excess_moment, 0.0, 2.0 * moment / section.bending, xtol=1e-14)
    return metric(turning), turning


def arc_error(belt: Belt, nodes: FloatArray, metric: float, turning: float) -> float:
    """Largest distance of a node from its place on an arc that leaves the origin along x, m."""
    x = np.linspace(0.0, belt.given_length, len(nodes))
    arc = sqrt(metric) / turning * np.stack([np.sin(turning * x), 1.0 - np.cos(turning * x)], axis=1)
    return float(np.linalg.norm(nodes[:, :2] - arc, axis=1).max())


@pytest.fixture(scope="module")
def roll_up(
    make_cantilever: Cantilever, along: Callable[[System, FloatArray, FloatArray], State]
) -> Callable[[float, int], tuple[Belt, FloatArray]]:
    """Belt and nodes in equilibrium; beginning near the circle spares a thin belt a thousand iterations."""

    def nodes(thickness: float, elements: int) -> tuple[Belt, FloatArray]:
        belt, system = make_cantilever(thickness, elements, moment=FULL_CIRCLE)
        angles = np.linspace(0.0, FULL_CIRCLE, elements + 1)
        places = np.stack([np.sin(angles), 1.0 - np.cos(angles)], axis=1) / FULL_CIRCLE
        return belt, find_equilibrium(system, along(system, places, angles)).state.nodes(system)

    return nodes


@pytest.mark.parametrize("thickness", [5e-2, 1e-2, 1e-3])
def test_order_against_the_closed_form(
    roll_up: Callable[[float, int], tuple[Belt, FloatArray]],
    order: Callable[..., float],
    measured: Callable[..., None],
    curve: Callable[..., None],
    thickness: float,
) -> None:
    errors = []
    for elements in MESHES:
        belt, nodes = roll_up(thickness, elements)
        errors.append(arc_error(belt, nodes, *pure_bending(belt, FULL_CIRCLE * belt.bending_stiffness)))
    coarse, fine = order(MESHES[:3], errors[:3]), order(MESHES[1:], errors[1:])
    measured(**{f"error_{n}": error for n, error in zip(MESHES, errors, strict=True)}, coarse=coarse, fine=fine)
    curve("roll_up", MESHES, errors, f"h/L = {thickness:g}")
    assert coarse == pytest.approx(3.7, abs=0.1)  # at 4 elements, 90 degrees each, not yet asymptotic
    assert fine == pytest.approx(4.0, abs=0.15)
    assert errors[-1] < 1e-5


def test_thin_belt_against_the_circle(
    roll_up: Callable[[float, int], tuple[Belt, FloatArray]], order: Callable[..., float], measured: Callable[..., None]
) -> None:
    """At h / L = 1e-3 the circle is (h theta)^2 / 8 = 5e-6 smaller than Euler's, less than these meshes miss."""
    meshes = MESHES[:3]
    errors = [arc_error(*roll_up(1e-3, elements), 1.0, FULL_CIRCLE) for elements in meshes]
    fitted = order(meshes, errors)
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=fitted)
    assert fitted == pytest.approx(3.7, abs=0.15)
    assert errors[-1] < 2e-4


def test_from_the_straight_belt(
    roll_up: Callable[[float, int], tuple[Belt, FloatArray]], make_cantilever: Cantilever
) -> None:
    """The same circle, to the tolerance of Newton's method on strain, 1e-11, times (L / h)^2."""
    _, system = make_cantilever(1e-2, 8, moment=FULL_CIRCLE)
    nodes = find_equilibrium(system, straight(system)).state.nodes(system)
    np.testing.assert_allclose(nodes, roll_up(1e-2, 8)[1], rtol=0.0, atol=1e-7)


def test_the_sections_stay_square_to_the_tangent(
    roll_up: Callable[[float, int], tuple[Belt, FloatArray]], measured: Callable[..., None]
) -> None:
    """A moment shears nothing; what the mesh leaves vanishes with its third power."""
    shears = {}
    for elements in (8, 16):
        _, nodes = roll_up(1e-2, elements)
        shears[elements] = float(np.abs(np.sum(nodes[:, 2:4] * nodes[:, 4:6], axis=1)).max())
    measured(shear_8=shears[8], shear_16=shears[16])
    assert shears[8] < 1e-5
    assert shears[16] < shears[8] / 7.0

"""Verified: the belt released from its two pulleys, the static example of section 5 of the paper.

Against: a circle.  Its radius is that of pure bending, sqrt(G) L / 2 pi with G = 1 - 3 (EI / EA) (2 pi / L)^2, which
is 3e-6 less than L / 2 pi; the published one is "a perfect circle" after 55 iterations of Newton's method.
"""

from collections.abc import Callable
from math import pi, sqrt
from typing import Literal

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt
from beltdyn.system.arrays import System
from beltdyn.system.state import State
from validation.published.released_belt import closed, on_pulleys, release, released_belt

Method = Literal["globalized", "newton"]
Start = Callable[[System], State]


@pytest.fixture(scope="module")
def ellipse(along: Callable[[System, FloatArray, FloatArray], State]) -> Callable[[float], Start]:
    """An ellipse of the belt's length, given by its slenderness, with equally spaced nodes."""

    def start(slenderness: float) -> Start:
        def state(system: System) -> State:
            turn = np.linspace(0.0, 2.0 * pi, 2001)
            outline = np.stack([np.cos(turn), slenderness * np.sin(turn)], axis=1)
            arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
            at = np.interp(np.arange(system.nodes) * arc[-1] / system.nodes, arc, turn)
            size = float(np.sum(system.length)) / arc[-1]
            places = size * np.stack([np.cos(at), slenderness * np.sin(at)], axis=1)
            return along(system, places, np.arctan2(slenderness * np.cos(at), -np.sin(at)))

        return state

    return start


def around_center(nodes: FloatArray) -> FloatArray:
    """Place, tangent and section of the nodes, each radial and circumferential about the center; shape (N, 6)."""
    place = nodes[:, :2] - nodes[:, :2].mean(axis=0)
    radial = place / np.linalg.norm(place, axis=1, keepdims=True)
    around = np.stack([-radial[:, 1], radial[:, 0]], axis=1)
    vectors = (place, nodes[:, 2:4], nodes[:, 4:6])
    return np.stack([np.sum(v * axis, axis=1) for v in vectors for axis in (radial, around)], axis=1)


def circle_radius(belt: Belt) -> float:
    contraction = 3.0 * belt.bending_stiffness / belt.axial_stiffness * (2.0 * pi / belt.given_length) ** 2
    return sqrt(1.0 - contraction) * belt.given_length / (2.0 * pi)


def assert_circle(belt: Belt, nodes: FloatArray) -> None:
    seen = around_center(nodes)
    np.testing.assert_allclose(seen, np.tile(seen[0], (len(seen), 1)), rtol=0.0, atol=1e-8)
    assert seen[0, 0] == pytest.approx(belt.given_length / (2.0 * pi), rel=3e-4)


@pytest.mark.parametrize(("method", "iterations"), [("globalized", 200), ("newton", 40)])
def test_the_papers_belt_becomes_a_circle(
    measured: Callable[..., None],
    curve: Callable[..., None],
    method: Method,
    iterations: int,
) -> None:
    belt = released_belt(10)
    system = closed(belt)
    found = release(belt, on_pulleys(system), method)
    nodes = found.state.nodes(system)
    assert_circle(belt, nodes)
    assert found.iterations <= iterations
    np.testing.assert_array_equal(found.iterates[0], on_pulleys(system).nodes(system))
    np.testing.assert_array_equal(found.iterates[-1], nodes)
    assert len(found.iterates) == found.iterations + 1
    curve("released_belt/iteration", np.arange(1, found.iterations + 1), found.norms, method)
    seen = around_center(nodes)
    measured(
        iterations=found.iterations,
        radius_error=2.0 * pi * seen[0, 0] / belt.given_length - 1.0,
        spread=float(np.ptp(seen, axis=0).max()),
    )


def test_radius_converges_to_that_of_pure_bending(
    order: Callable[..., float], measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    """At order 4, that of cubics in the energy of second derivatives."""
    meshes = [10, 20, 40, 80]
    errors = []
    for elements in meshes:
        belt = released_belt(elements)
        system = closed(belt)
        found = release(belt, on_pulleys(system))
        errors.append(around_center(found.state.nodes(system))[0, 0] / circle_radius(belt) - 1.0)
    fitted = order(meshes, errors)
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=fitted)
    curve("released_belt/radius", meshes, errors, "radius")
    assert fitted == pytest.approx(4.0, abs=0.05)


@pytest.mark.parametrize("elements", [10, 20, 40])
@pytest.mark.parametrize("slenderness", [0.3, 0.5, 0.8, 2.0])
def test_an_ellipse_becomes_a_circle(
    ellipse: Callable[[float], Start],
    slenderness: float,
    elements: int,
) -> None:
    belt = released_belt(elements)
    system = closed(belt)
    found = release(belt, ellipse(slenderness)(system))
    assert_circle(belt, found.state.nodes(system))


@pytest.mark.parametrize("seed", range(10))
def test_a_disturbed_belt_becomes_a_circle(seed: int) -> None:
    """Nodes off by 1 cm, tangents and sections by 1 degree."""

    def disturbed(system: System) -> State:
        state = on_pulleys(system)
        size = [0.01, 0.01, 0.02, 0.02, 0.02, 0.02]
        state.nodes(system)[:] += np.random.default_rng(seed).uniform(-1.0, 1.0, (system.nodes, 6)) * size
        return state

    belt = released_belt(10)
    system = closed(belt)
    found = release(belt, disturbed(system))
    assert_circle(belt, found.state.nodes(system))

"""Verified: the belt released from its two pulleys, the static example of section 5 of the paper.

Against: a circle.  Its radius is that of pure bending, sqrt(G) L / 2 pi with G = 1 - 3 (EI / EA) (2 pi / L)^2, which
is 3e-6 less than L / 2 pi; the published one is "a perfect circle" after 55 iterations of Newton's method.
"""

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.system.build import belt_system
from beltdyn.system.state import State
from validation.published.released_belt import released_belt

Start = Callable[[Drive], FloatArray]


@pytest.fixture(scope="module")
def ellipse(along: Callable[..., State]) -> Callable[[float], Start]:
    """An ellipse of the belt's length, given by its slenderness, with equally spaced nodes."""

    def start(slenderness: float) -> Start:
        def coordinates(drive: Drive) -> FloatArray:
            system = belt_system(drive.belt, closure="shared_node")
            turn = np.linspace(0.0, 2.0 * pi, 2001)
            outline = np.stack([np.cos(turn), slenderness * np.sin(turn)], axis=1)
            arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
            at = np.interp(np.arange(system.nodes) * arc[-1] / system.nodes, arc, turn)
            size = float(np.sum(system.length)) / arc[-1]
            places = size * np.stack([np.cos(at), slenderness * np.sin(at)], axis=1)
            return along(system, places, np.arctan2(slenderness * np.cos(at), -np.sin(at))).nodes(system)

        return coordinates

    return start


def around_center(nodes: FloatArray) -> FloatArray:
    """Place, tangent and section of the nodes, each radial and circumferential about the center; shape (N, 6)."""
    place = nodes[:, :2] - nodes[:, :2].mean(axis=0)
    radial = place / np.linalg.norm(place, axis=1, keepdims=True)
    around = np.stack([-radial[:, 1], radial[:, 0]], axis=1)
    vectors = (place, nodes[:, 2:4], nodes[:, 4:6])
    return np.stack([np.sum(v * axis, axis=1) for v in vectors for axis in (radial, around)], axis=1)


def circle_radius(drive: Drive) -> float:
    belt, length = drive.belt, drive.belt_length
    contraction = 3.0 * belt.bending_stiffness / belt.axial_stiffness * (2.0 * pi / length) ** 2
    return sqrt(1.0 - contraction) * length / (2.0 * pi)


def last_shape(found: bd.Result) -> FloatArray:
    return np.asarray(found.dataset["nodal_coordinates"][-1])


def assert_circle(drive: Drive, nodes: FloatArray) -> None:
    seen = around_center(nodes)
    np.testing.assert_allclose(seen, np.tile(seen[0], (len(seen), 1)), rtol=0.0, atol=1e-8)
    assert seen[0, 0] == pytest.approx(drive.belt_length / (2.0 * pi), rel=3e-4)


@pytest.mark.parametrize(("method", "iterations"), [("globalized", 200), ("newton", 40)])
def test_the_papers_belt_becomes_a_circle(
    measured: Callable[..., None], curve: Callable[..., None], method: str, iterations: int
) -> None:
    drive = released_belt(10)
    found = bd.release(drive, method=method)
    assert_circle(drive, last_shape(found))
    count = found.dataset.iterations.item()
    assert count <= iterations
    assert found.dataset.sizes["iteration"] == count + 1
    nodes_on_path = drive.path.position(found.dataset.node_coordinate.values * drive.path.length / drive.belt_length)
    np.testing.assert_allclose(found.dataset.node_position[0], nodes_on_path, rtol=0.0, atol=1e-12)
    curve("released_belt/iteration", np.arange(1, count + 1), found.dataset.step_strain[1:].values, method)
    seen = around_center(last_shape(found))
    measured(
        iterations=count,
        radius_error=2.0 * pi * seen[0, 0] / drive.belt_length - 1.0,
        spread=float(np.ptp(seen, axis=0).max()),
    )


def test_the_energy_that_is_left_is_that_of_bending() -> None:
    """E I / 2 (2 pi / L)^2 L on a fine mesh; what the contraction adds is of the order of E I / E A / R^2."""
    drive = released_belt(40)
    energy = bd.release(drive).dataset.strain_energy[-1].item()
    bending = 0.5 * drive.belt.bending_stiffness * (2.0 * pi) ** 2 / drive.belt_length
    assert energy == pytest.approx(bending, rel=1e-4)


def test_radius_converges_to_that_of_pure_bending(
    order: Callable[..., float], measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    """At order 4, that of cubics in the energy of second derivatives."""
    meshes = [10, 20, 40, 80]
    errors = []
    for elements in meshes:
        drive = released_belt(elements)
        errors.append(around_center(last_shape(bd.release(drive)))[0, 0] / circle_radius(drive) - 1.0)
    fitted = order(meshes, errors)
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=fitted)
    curve("released_belt/radius", meshes, errors, "radius")
    assert fitted == pytest.approx(4.0, abs=0.05)


@pytest.mark.parametrize("elements", [10, 20, 40])
@pytest.mark.parametrize("slenderness", [0.3, 0.5, 0.8, 2.0])
def test_an_ellipse_becomes_a_circle(ellipse: Callable[[float], Start], slenderness: float, elements: int) -> None:
    drive = released_belt(elements)
    found = bd.release(drive, start=ellipse(slenderness)(drive))
    assert_circle(drive, last_shape(found))


@pytest.mark.parametrize("seed", range(10))
def test_a_disturbed_belt_becomes_a_circle(seed: int) -> None:
    """Nodes off by 1 cm, tangents and sections by 1 degree."""
    drive = released_belt(10)
    laid = bd.release(drive).dataset["nodal_coordinates"][0].values
    size = [0.01, 0.01, 0.02, 0.02, 0.02, 0.02]
    start = laid + np.random.default_rng(seed).uniform(-1.0, 1.0, laid.shape) * size
    assert_circle(drive, last_shape(bd.release(drive, start=start)))

"""What every element kind promises (`ElementKind`), on elements that lie on a straight line."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements import ELEMENTS, damping_force, elastic_force, strain_energy, tension
from beltdyn.elements.kind import DampingFactors, ElementKind, Section
from beltdyn.model import Drive
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import StretchParameters
from beltdyn.system.state import belt_section

LENGTH = 0.06
DIRECTION = np.array([0.8, -0.6])
ROUNDING = 1e-12


@pytest.fixture(params=list(ELEMENTS.values()), ids=list(ELEMENTS))
def kind(request: pytest.FixtureRequest) -> ElementKind:
    chosen: ElementKind = request.param
    return chosen


@pytest.fixture(scope="module")
def section(drive: Drive, stretch_law: StretchParameters) -> Section:
    """With each law of stretch."""
    return belt_section(drive.belt)._replace(stretch=stretch_law)


def stretched(kind: ElementKind, stretch: float) -> FloatArray:
    """Coordinates of an element on a line, its material points evenly apart."""
    points = 2 * kind.points
    place = np.array([0.3, 0.1]) + stretch * LENGTH / kind.points * np.arange(points)[:, None] * DIRECTION
    slope = np.tile(stretch * DIRECTION, (points, 1))
    return kind.nodal(place, slope, np.zeros((points, 2))).ravel()


def vectors_of(kind: ElementKind, e: FloatArray) -> FloatArray:
    return np.stack([e[first : first + 2] for first in kind.vectors])


def force(kind: ElementKind, element: Any, e: FloatArray) -> tuple[FloatArray, FloatArray]:
    work = blank(kind.workspace)
    elastic_force(element, e, LENGTH, True, work)
    return work.gradient, work.tangent


def test_coordinates_and_vectors_fit(kind: ElementKind) -> None:
    e = stretched(kind, 1.0)
    assert e.shape == (2 * kind.dof,)
    assert len(kind.scale(LENGTH)) == kind.dof
    assert len(kind.shift) == len(kind.vectors) == kind.control(LENGTH).shape[2]
    assert kind.curves == len(kind.control(LENGTH))


def test_a_shift_takes_all_control_points_along(kind: ElementKind) -> None:
    np.testing.assert_allclose(kind.control(LENGTH) @ kind.shift, 1.0, rtol=ROUNDING)


def test_curves_lie_evenly_on_the_line(kind: ElementKind) -> None:
    """One after the other from the first node to the second."""
    control = kind.control(LENGTH) @ vectors_of(kind, stretched(kind, 1.1))
    curves, count, _ = control.shape
    part = (np.arange(curves)[:, None] + np.arange(count) / (count - 1)) / curves
    expected = np.array([0.3, 0.1]) + 1.1 * LENGTH * part[..., None] * DIRECTION
    np.testing.assert_allclose(control, expected, atol=ROUNDING)


@pytest.mark.parametrize("stretch", [0.9, 1.0, 1.2])
def test_ends_are_pulled_by_the_tension(kind: ElementKind, section: Section, stretch: float) -> None:
    """By the slope of the energy over the stretch, which `tension` reports; all vectors else are in balance."""
    element = kind.element(section, gauss_points(4))
    e = stretched(kind, stretch)
    pull = tension(element, stretch**2, 0.0)
    assert np.sign(pull) == np.sign(stretch - 1.0)
    longer, shorter = (strain_energy(element, stretched(kind, stretch + h), LENGTH) for h in (1e-6, -1e-6))
    assert (longer - shorter) / 2e-6 == pytest.approx(LENGTH * pull, rel=1e-8, abs=1e-8 * section.axial * LENGTH)
    gradient, _ = force(kind, element, e)
    along = gradient @ (stretched(kind, 2.0) - stretched(kind, 1.0))
    assert along == pytest.approx(LENGTH * pull, abs=ROUNDING * section.axial)
    shifts = np.zeros((2, 2 * kind.dof))
    for first, weight in zip(kind.vectors, kind.shift, strict=True):
        shifts[0, first], shifts[1, first + 1] = weight, weight
    np.testing.assert_allclose(shifts @ gradient, 0.0, atol=ROUNDING * section.axial)


@pytest.mark.parametrize("seed", range(3))
def test_derivatives(kind: ElementKind, section: Section, seed: int) -> None:
    """Force and tangent are slopes of energy and force, to what differences of fourth order can show."""
    scale = np.tile([LENGTH / each for each in kind.scale(LENGTH)], 2)
    e = stretched(kind, 1.0) + 0.1 * scale * np.random.default_rng(seed).uniform(-1.0, 1.0, 2 * kind.dof)
    element, step = kind.element(section, gauss_points(4)), 1e-5
    gradient, tangent = force(kind, element, e)
    moves = step * np.diag(scale)

    def slopes(of: Callable[[FloatArray], Any]) -> FloatArray:
        """Differences of fourth order along each coordinate."""
        near, far = (np.array([of(e + k * h) - of(e - k * h) for h in moves]) for k in (1, 2))
        return np.asarray((8.0 * near - far) / (12.0 * step))

    of_energy = slopes(lambda there: strain_energy(element, there, LENGTH))
    np.testing.assert_allclose(scale * gradient, of_energy, atol=2e-8 * np.abs(of_energy).max())
    of_force = slopes(lambda there: scale * force(kind, element, there)[0])
    np.testing.assert_allclose(scale[:, None] * tangent * scale, of_force, atol=2e-8 * np.abs(of_force).max())


def test_unstretched_it_is_free(kind: ElementKind, section: Section) -> None:
    element, e = kind.element(section, gauss_points(4)), stretched(kind, 1.0)
    assert strain_energy(element, e, LENGTH) == pytest.approx(0.0, abs=ROUNDING * section.axial * LENGTH)
    np.testing.assert_allclose(force(kind, element, e)[0], 0.0, atol=ROUNDING * section.axial)


def test_mass_of_a_translation(kind: ElementKind, section: Section) -> None:
    """m V^2 / 2, on whatever coordinates the mass acts."""
    matrix = kind.mass(section, LENGTH)
    np.testing.assert_array_equal(matrix, matrix.T)
    velocity = np.zeros(2 * kind.dof)
    for first, weight in zip(kind.vectors, kind.shift, strict=True):
        velocity[first : first + 2] = weight * np.array([3.0, -4.0])
    assert 0.5 * velocity @ matrix @ velocity == pytest.approx(12.5 * section.mass * LENGTH)


def test_what_a_kind_without_damping_adds(kind: ElementKind, section: Section) -> None:
    """Nothing; and of a belt without damping nobody adds anything."""
    section = section._replace(axial_damping=0.0, bending_damping=0.0)
    work, e = blank(kind.workspace), stretched(kind, 1.1)
    work.gradient[:], work.tangent[:] = 3.0, 5.0
    lost = damping_force(
        kind.element(section, gauss_points(4)), e, e[::-1].copy(), LENGTH, DampingFactors(1.0, 2.0, 0.0), work
    )
    assert lost == (0.0, 0.0)
    np.testing.assert_array_equal(work.gradient, 3.0)
    np.testing.assert_array_equal(work.tangent, 5.0)
    assert kind.is_damped == (kind.name in ("ancf", "quintic"))

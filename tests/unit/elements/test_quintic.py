"""The quintic element: derivatives, rigid motion, mass, pure bending, and how it meets its neighbors."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.ancf.elastic_force import energy_density
from beltdyn.elements.kind import DampingFactors, Section
from beltdyn.elements.planar_curve import hysteretic
from beltdyn.elements.quintic import QUINTIC, Quintic, bending_of, bends, slopes, thirds
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green, stretching
from beltdyn.system.frame import staying

LENGTH, AXIAL, BENDING, QUARTIC, MASS = 0.05, 1e4, 0.02, 2e-6, 0.1
SECTION = Section(Green(AXIAL), *[0.0] * 7)._replace(bending=BENDING, quartic=QUARTIC, mass=MASS)
ELEMENT = Quintic(SECTION, gauss_points(4))
SCALE = np.tile([LENGTH, LENGTH, 1.0, 1.0, 1.0 / LENGTH, 1.0 / LENGTH], 2)
"""Changes of the coordinates that strain alike."""
STRAIGHT = np.array([0, 0, 1, 0, 0, 0, LENGTH, 0, 1, 0, 0, 0], dtype=float)
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5, relative to the largest entry."""


def forces(e: FloatArray, wanted: bool = True) -> tuple[FloatArray, FloatArray]:
    work = blank(QUINTIC.workspace)
    work.tangent[:] = 7.0
    QUINTIC.force(ELEMENT, e, LENGTH, wanted, work)
    return work.gradient, work.tangent


@pytest.fixture(params=range(4))
def deformed(request: pytest.FixtureRequest) -> FloatArray:
    """Stretched and bent."""
    return STRAIGHT + 0.1 * SCALE * np.random.default_rng(request.param).uniform(-1.0, 1.0, 12)


def test_force_is_the_slope_of_the_energy(deformed: FloatArray) -> None:
    moves = 1e-5 * np.diag(SCALE)
    found = [
        QUINTIC.energy(ELEMENT, deformed + h, LENGTH) - QUINTIC.energy(ELEMENT, deformed - h, LENGTH) for h in moves
    ]
    expected = SCALE * forces(deformed)[0]
    np.testing.assert_allclose(np.array(found) / 2e-5, expected, atol=DIFFERENCES * np.abs(expected).max())


def test_tangent_is_the_slope_of_the_force(deformed: FloatArray) -> None:
    moves = 1e-5 * np.diag(SCALE)
    found = np.array([SCALE * (forces(deformed + h)[0] - forces(deformed - h)[0]) for h in moves]) / 2e-5
    expected = SCALE[:, None] * forces(deformed)[1] * SCALE
    np.testing.assert_allclose(found, expected, atol=DIFFERENCES * np.abs(expected).max())


def test_force_without_tangent(deformed: FloatArray) -> None:
    alone, kept = forces(deformed, False)
    np.testing.assert_array_equal(alone, forces(deformed)[0])
    np.testing.assert_array_equal(kept, 7.0)


@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0])
def test_rigid_motion_takes_no_force(angle: float) -> None:
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    moved = (STRAIGHT.reshape(6, 2) @ turn + np.outer([1, 0, 0, 1, 0, 0], [0.3, -0.4])).ravel()
    np.testing.assert_allclose(forces(moved)[0], 0.0, atol=1e-13 * AXIAL)


@pytest.mark.parametrize("stretch", [0.9, 1.05])
def test_uniform_stretch(stretch: float) -> None:
    """The ends are pulled by E A alpha1 (G - 1) |q| / 2."""
    e = STRAIGHT.copy()
    e[[2, 6, 8]] *= stretch
    pull = 0.5 * AXIAL * (stretch**2 - 1.0) * stretch
    expected = np.zeros(12)
    expected[[0, 6]] = -pull, pull
    np.testing.assert_allclose(forces(e)[0], expected, atol=1e-12 * AXIAL)
    assert QUINTIC.tension(ELEMENT, stretch**2, 0.0) == pytest.approx(pull)


def test_energy_of_an_arc() -> None:
    """EI L / 2 R^2 + E I4 L / 8 R^4: a quintic through nodes on a circle misses it by the sixth power of its angle."""
    errors = []
    for angle in (0.8, 0.4):
        radius = LENGTH / angle
        turned = np.array([0.0, angle])
        place = radius * np.stack([np.sin(turned), 1.0 - np.cos(turned)], axis=1)
        tangent = np.stack([np.cos(turned), np.sin(turned)], axis=1)
        bend = np.stack([-np.sin(turned), np.cos(turned)], axis=1) / radius
        energy = QUINTIC.energy(ELEMENT, QUINTIC.nodal(place, tangent, bend).ravel(), LENGTH)
        errors.append(abs(energy / (LENGTH * (0.5 * BENDING / radius**2 + 0.125 * QUARTIC / radius**4)) - 1.0))
    assert errors[0] < 1e-5
    assert np.log2(errors[0] / errors[1]) > 5.5


@pytest.mark.parametrize("stretch", [0.95, 1.1])
@pytest.mark.parametrize("turning", [-3.0, 20.0])
def test_energy_is_that_of_the_papers_element_without_shear(stretch: float, turning: float) -> None:
    """At a point: G and theta' are all that sections normal to the centerline leave of Eqs. 14 and 15."""
    expected = energy_density(stretch**2, turning, 0.0, 0.0, SECTION)
    along = stretching(SECTION.stretch, stretch**2).energy
    found = along + bending_of(SECTION, stretch**2, stretch**2 * turning).energy
    assert found == pytest.approx(expected, rel=1e-14)


def test_factors_are_the_derivatives_of_the_curve_that_contact_sees() -> None:
    """Derivatives of the Bezier curve by the differences of its control points, at both ends."""
    control = QUINTIC.control(LENGTH)[0]
    first, second = 5.0 * np.diff(control, axis=0) / LENGTH, 20.0 * np.diff(control, 2, axis=0) / LENGTH**2
    third = 60.0 * np.diff(control, 3, axis=0) / LENGTH**3
    for xi, end in ((0.0, 0), (1.0, -1)):
        np.testing.assert_allclose(thirds(xi, LENGTH), third[end], atol=1e-12 / LENGTH**3)
        np.testing.assert_allclose(slopes(xi, LENGTH), first[end], atol=1e-12 / LENGTH)
        np.testing.assert_allclose(bends(xi, LENGTH), second[end], atol=1e-12 / LENGTH**2)


DAMPED = Quintic(SECTION._replace(axial_damping=30.0, bending_damping=1e-4), gauss_points(4))
LOSSY = Quintic(SECTION._replace(bending_hysteresis=0.01, passing_length=0.03), gauss_points(4))
VELOCITY = 2.0 * SCALE * np.random.default_rng(7).uniform(-1.0, 1.0, 12)


def damping(
    e: FloatArray,
    velocity: FloatArray,
    by_position: float = 0.0,
    by_velocity: float = 0.0,
    *,
    element: Quintic = DAMPED,
) -> tuple[tuple[float, float], FloatArray, FloatArray]:
    work = blank(QUINTIC.workspace)
    powers = QUINTIC.damping(element, e, velocity, LENGTH, DampingFactors(by_position, by_velocity, 0.0), work)
    return powers, work.gradient, work.tangent


def test_power_of_damping_is_that_of_the_strain_rates(deformed: FloatArray) -> None:
    """A and B times the squares of the rates of sqrt(G) - 1 and c / sqrt(G), by complex steps."""
    moved, expected = (deformed + 1e-30j * VELOCITY).reshape(6, 2), np.zeros(2)
    for xi, weight in zip(*gauss_points(4), strict=True):
        q, w = slopes(xi, LENGTH) @ moved, bends(xi, LENGTH) @ moved
        strains = np.array([np.sqrt(q @ q) - 1.0, (q[0] * w[1] - q[1] * w[0]) / np.sqrt(q @ q)])
        expected += weight * LENGTH * np.array([30.0, 1e-4]) * (strains.imag / 1e-30) ** 2
    powers, force, _ = damping(deformed, VELOCITY)
    np.testing.assert_allclose(powers, expected, rtol=1e-11)
    assert force @ VELOCITY == pytest.approx(sum(powers), rel=1e-12)


@pytest.mark.parametrize(("element", "accuracy"), [(DAMPED, DIFFERENCES), (LOSSY, 1e-6)])
@pytest.mark.parametrize("by", [(1.0, 0.0), (0.0, 1.0), (0.7, 30.0)])
def test_tangent_of_damping_is_the_slope_of_the_force(
    deformed: FloatArray, by: tuple[float, float], element: Quintic, accuracy: float
) -> None:
    """Hysteresis bends sharply where the curvature and its rate are small: its differences err more."""
    found = np.zeros((12, 12))
    for column, move in enumerate(1e-5 * np.diag(SCALE)):
        ends = [damping(deformed + s * by[0] * move, VELOCITY + s * by[1] * move, element=element)[1] for s in (1, -1)]
        found[:, column] = SCALE * (ends[0] - ends[1]) / 2e-5
    expected = SCALE[:, None] * damping(deformed, VELOCITY, *by, element=element)[2] * SCALE
    np.testing.assert_allclose(found, expected, atol=accuracy * np.abs(expected).max())


@pytest.mark.parametrize("element", [DAMPED, LOSSY])
def test_tangent_of_damping_in_a_belt_that_flows(deformed: FloatArray, element: Quintic) -> None:
    """Vectors D e of dr/dx, by the derivative of the curve itself, change velocities: to rounding."""
    flow = np.kron(staying(QUINTIC.control(LENGTH)[None], np.array([LENGTH]), MASS).derivative[0], np.eye(2))
    by_velocity = damping(deformed, VELOCITY, 0.0, 1.0, element=element)[2]
    work = blank(QUINTIC.workspace)
    QUINTIC.damping(element, deformed, VELOCITY, LENGTH, DampingFactors(0.7, 0.0, 3.0), work)
    expected = damping(deformed, VELOCITY, 0.7, element=element)[2] + 3.0 * by_velocity @ flow
    scaled = SCALE[:, None] * expected * SCALE
    np.testing.assert_allclose(SCALE[:, None] * work.tangent * SCALE, scaled, atol=1e-12 * np.abs(scaled).max())
    column = SCALE * (by_velocity @ flow @ deformed)
    np.testing.assert_allclose(SCALE * work.by_flow, column, atol=1e-11 * np.abs(column).max())


def test_the_secant_of_hysteresis_times_the_rates_is_its_force(deformed: FloatArray) -> None:
    """And what the square of the belt's speed adds to it, which grows with the rates of the nodes too."""
    work = blank(QUINTIC.workspace)
    QUINTIC.damping(LOSSY, deformed, VELOCITY, LENGTH, DampingFactors(0.0, 1.0, 0.0, True), work)
    square = float(np.sum((0.5 * (VELOCITY[:2] + VELOCITY[6:8])) ** 2))
    force = SCALE * (work.gradient + 2.0 * square * work.by_square)
    np.testing.assert_allclose(SCALE * (work.tangent @ VELOCITY), force, atol=1e-12 * np.abs(force).max())
    by_slope = damping(deformed, VELOCITY, 0.0, 1.0, element=LOSSY)[2]
    assert np.abs(SCALE * (by_slope @ VELOCITY) - force).max() > 0.1 * np.abs(force).max()


def test_power_of_hysteresis_is_that_of_the_law_at_points(deformed: FloatArray) -> None:
    """With the curvature c / sqrt(G), its rate by complex steps, and the mean velocity of both ends."""
    moved, expected = (deformed + 1e-30j * VELOCITY).reshape(6, 2), 0.0
    square = float(np.sum((0.5 * (VELOCITY[:2] + VELOCITY[6:8])) ** 2))
    for xi, weight in zip(*gauss_points(4), strict=True):
        q, w = slopes(xi, LENGTH) @ moved, bends(xi, LENGTH) @ moved
        curvature = (q[0] * w[1] - q[1] * w[0]) / np.sqrt(q @ q)
        rate = float(curvature.imag) / 1e-30
        expected += weight * LENGTH * hysteretic(0.01, float(curvature.real), rate, square, 0.03).stress * rate
    powers, force, _ = damping(deformed, VELOCITY, element=LOSSY)
    assert powers[0] == 0.0
    assert powers[1] == pytest.approx(expected, rel=1e-11)
    assert force @ VELOCITY == pytest.approx(expected, rel=1e-11)


def test_rigid_motion_is_not_damped(deformed: FloatArray) -> None:
    turning = np.stack([-deformed[1::2], deformed[::2]], axis=1).ravel()
    largest = np.abs(damping(deformed, VELOCITY)[1]).max()
    np.testing.assert_allclose(damping(deformed, 2.0 * turning)[1], 0.0, atol=1e-12 * largest)


def test_mass_moves_as_a_rigid_line() -> None:
    """Kinetic energy of a translation and of a rotation about the middle."""
    mass = QUINTIC.mass(SECTION, LENGTH)
    shift, spin = np.zeros(12), np.zeros(12)
    shift[[0, 6]] = 1.0
    spin[[1, 3, 7, 9]] = -LENGTH / 2.0, 1.0, LENGTH / 2.0, 1.0
    assert shift @ mass @ shift == pytest.approx(MASS * LENGTH)
    assert spin @ mass @ spin == pytest.approx(MASS * LENGTH**3 / 12.0)
    assert shift @ mass @ spin == pytest.approx(0.0, abs=1e-15)

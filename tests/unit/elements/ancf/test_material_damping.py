from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.ancf import ANCF
from beltdyn.elements.ancf.elastic_force import element_energy, element_force
from beltdyn.elements.ancf.element import Ancf
from beltdyn.elements.ancf.material_damping import damping_force
from beltdyn.elements.kind import DampingFactors, Section, damping_tension
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green, Linear

Damping = Callable[..., tuple[float, FloatArray, FloatArray]]

STRETCH, BENDING = 3e-3, 7e-3
"""Damping times, s."""


def damped(section: Section, stretch: float = STRETCH, bending: float = BENDING) -> Section:
    return section._replace(axial_damping=section.axial * stretch, bending_damping=section.bending * bending)


def unresisting(section: Section) -> Section:
    """Without stiffness, damping and inertia."""
    return Section(Green(0.0), *(0.0 for _ in section[1:]))


@pytest.fixture(params=range(5))
def state(request: pytest.FixtureRequest, unloaded: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
    """An element stretched, bent, sheared and thickened, and any velocities."""
    random = np.random.default_rng(request.param)
    scale = np.tile([length, length, 1, 1, 1, 1], 2)
    return unloaded + scale * random.uniform(-0.2, 0.2, 12), scale * random.uniform(-1.0, 1.0, 12)


@pytest.fixture
def damping(length: float) -> Damping:
    """Power, force and tangent of an element."""

    def values(
        e: FloatArray, velocity: FloatArray, section: Section, by_position: float = 0.0, by_velocity: float = 0.0
    ) -> tuple[float, FloatArray, FloatArray]:
        work = blank(ANCF.workspace)
        element = Ancf(section, gauss_points(4))
        powers = damping_force(element, e, velocity, length, DampingFactors(by_position, by_velocity, 0.0), work)
        return sum(powers), work.gradient, work.tangent

    return values


def strains(e: FloatArray, length: float, xi: float) -> tuple[float, float]:
    """Elongation and curvature at a point, by formulas of their own, which complex numbers may enter."""
    a = np.array([-6 * xi * (1 - xi) / length, 1 - 4 * xi + 3 * xi**2, 6 * xi * (1 - xi) / length, 3 * xi**2 - 2 * xi])
    b = np.array([-6 + 12 * xi, length * (6 * xi - 4), 6 - 12 * xi, length * (6 * xi - 2)]) / length**2
    vectors = e.reshape(6, 2)[[0, 1, 3, 4]]
    (qx, qy), (wx, wy) = a @ vectors, b @ vectors
    sines = []
    for k in (2, 8):
        tx, ty, sx, sy = e[k : k + 4]
        sines.append(-(tx * sx + ty * sy) / np.sqrt((tx * tx + ty * ty) * (sx * sx + sy * sy)))
    stretch = np.sqrt(qx * qx + qy * qy)
    turning = (qx * wy - qy * wx) / stretch**2
    return stretch - 1, stretch * (turning + (sines[1] - sines[0]) / length)


def test_power_is_that_of_the_strain_rates(
    state: tuple[FloatArray, FloatArray], damping: Damping, section: Section, length: float
) -> None:
    """2 R with the rates of the strains by complex steps, which have no rounding: equal to 12 digits."""
    e, velocity = state
    dissipated = 0.0
    for xi, weight in zip(*gauss_points(4), strict=True):
        stretch, bend = (value.imag / 1e-30 for value in strains(e + 1e-30j * velocity, length, xi))
        rates = STRETCH * section.axial * stretch**2 + BENDING * section.bending * bend**2
        dissipated += weight * length * rates
    power, force, _ = damping(e, velocity, damped(section))
    assert power == pytest.approx(dissipated, rel=1e-12)
    assert force @ velocity == pytest.approx(dissipated, rel=1e-12)


def test_rigid_motion_meets_no_resistance(
    state: tuple[FloatArray, FloatArray], damping: Damping, section: Section
) -> None:
    """Translation loses nothing at all; rotation what rounding leaves of forces of the size that other motions meet."""
    e, velocity = state
    drift = np.tile([3.0, -4.0, 0.0, 0.0, 0.0, 0.0], 2)
    power, force, _ = damping(e, drift, damped(section))
    assert power == 0.0
    np.testing.assert_array_equal(force, 0.0)
    spin = np.stack([-e[1::2], e[::2]], axis=1).ravel()
    power, force, _ = damping(e, drift + 5.0 * spin, damped(section))
    usual_power, usual_force, _ = damping(e, velocity, damped(section))
    assert power <= 1e-26 * usual_power
    np.testing.assert_allclose(force, 0.0, atol=1e-12 * np.abs(usual_force).max())


@pytest.mark.parametrize("by", [(1.0, 0.0), (0.0, 1.0), (0.3, 20.0)])
@pytest.mark.parametrize("times", [(STRETCH, 0.0), (0.0, BENDING)])
def test_tangent_is_that_of_the_force(
    state: tuple[FloatArray, FloatArray],
    damping: Damping,
    section: Section,
    length: float,
    by: tuple[float, float],
    times: tuple[float, float],
) -> None:
    """Central differences with a step of 1e-5: to 1e-9 of the largest entry, where truncation and rounding meet."""
    e, velocity = state
    _, _, tangent = damping(e, velocity, damped(section, *times), *by)
    columns = []
    for unit, scale in zip(np.eye(12), np.tile([length, length, 1, 1, 1, 1], 2), strict=True):
        step = 1e-5 * scale * unit
        ahead, behind = (
            damping(e + sign * by[0] * step, velocity + sign * by[1] * step, damped(section, *times))[1]
            for sign in (1.0, -1.0)
        )
        columns.append((ahead - behind) / (2e-5 * scale))
    np.testing.assert_allclose(tangent, np.stack(columns, axis=1), atol=1e-9 * np.abs(tangent).max())


def test_tension_of_uniform_stretching(unloaded: FloatArray, damping: Damping, section: Section, length: float) -> None:
    """The ends of an element that stretches evenly are pulled by the tension of damping."""
    e, velocity = unloaded.copy(), np.zeros(12)
    e[[2, 6, 8]] *= 1.1
    velocity[[2, 6, 8]] = 3.0 * np.array([1.0, length, 1.0])
    _, force, _ = damping(e, velocity, damped(section))
    pull = damping_tension(1.1**2, 2.0 * 1.1 * 3.0, damped(section))
    expected = np.zeros(12)
    expected[[0, 6]] = -pull, pull
    np.testing.assert_allclose(force, expected, atol=1e-12 * pull)


def test_straight_belt_damps_as_it_resists(
    unloaded: FloatArray, damping: Damping, section: Section, length: float
) -> None:
    """C = tau K for the axial part; likewise for bending without shear: the closed form of Kelvin-Voigt damping."""
    for part, time in (("stretch", STRETCH), ("bending", BENDING)):
        alone = unresisting(section)._replace(**{part: getattr(section, part)})
        work = blank(ANCF.workspace)
        element_force(Ancf(alone, gauss_points(4)), unloaded, length, True, work)
        stiffness = work.tangent
        matrix = damping(unloaded, np.zeros(12), damped(alone, time, time), 0.0, 1.0)[2]
        np.testing.assert_allclose(matrix, time * stiffness, atol=1e-14 * time * np.abs(stiffness).max())


def test_force_without_tangent(state: tuple[FloatArray, FloatArray], damping: Damping, section: Section) -> None:
    """The same power and force; no tangent."""
    power, force, _ = damping(*state, damped(section), 0.5, 2.0)
    power_alone, force_alone, tangent = damping(*state, damped(section), 0.0, 0.0)
    assert power_alone == power
    np.testing.assert_array_equal(force_alone, force)
    assert not tangent.any()


def test_adds_to_what_is_there(
    state: tuple[FloatArray, FloatArray], damping: Damping, section: Section, length: float
) -> None:
    """Force and tangent are added; the scratch arrays and what stood in them leave no trace."""
    e, velocity = state
    _, force, tangent = damping(e, velocity, damped(section), 0.5, 2.0)
    work = blank(ANCF.workspace)
    work.gradient[:], work.tangent[:] = 1.0, 1.0
    for _ in range(2):
        damping_force(Ancf(damped(section), gauss_points(4)), e, velocity, length, DampingFactors(0.5, 2.0, 0.0), work)
    np.testing.assert_allclose(work.gradient, 1.0 + 2.0 * force, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(work.tangent, 1.0 + 2.0 * tangent, rtol=1e-12, atol=1e-12)


def test_elastic_strains_are_the_same(state: tuple[FloatArray, FloatArray], section: Section, length: float) -> None:
    """The axial energy of the linear law is that of the elongation which is damped, to rounding."""
    e, _ = state
    alone = unresisting(section)._replace(stretch=Linear(section.axial))
    expected = sum(
        0.5 * section.axial * weight * length * strains(e, length, xi)[0] ** 2
        for xi, weight in zip(*gauss_points(4), strict=True)
    )
    assert element_energy(Ancf(alone, gauss_points(4)), e, length) == pytest.approx(expected, rel=1e-12)

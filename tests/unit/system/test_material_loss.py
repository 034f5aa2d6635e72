"""Hysteresis of an element: exact tangents, power, and what it leaves alone."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, Records, blank
from beltdyn.model import Belt, Drive, prepare
from beltdyn.model.hysteresis import Passing
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.material_loss import add_hysteresis, hysteresis_tension
from beltdyn.theory.nip import BENDING_SHARE, STRETCH_SHARE

PASSING = Passing(strain=0.01, stretch_length=0.05, bending_length=0.02)
DIFFERENCES = 1e-6
"""Central differences with a step of 1e-7, relative to the largest entry."""


@pytest.fixture(params=["ancf", "quintic"])
def system(request: pytest.FixtureRequest, drive: Drive) -> System:
    belt = drive.belt.replace(
        elements=8, discretization=request.param, stretch_loss_factor=0.08, bending_loss_factor=0.15
    )
    return belt_system(belt, passing=PASSING)


@pytest.fixture(params=range(4))
def state(request: pytest.FixtureRequest, system: System) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Coordinates of an element, stretched and bent, their rates, and lengths that turn changes of both into m."""
    random, length = np.random.default_rng(request.param), system.length[0]
    scale = length / np.tile(system.scale, 2)
    straight = np.zeros(scale.size)
    straight[scale.size // 2] = length
    straight[[2, scale.size // 2 + 2]] = 1.0
    return (
        straight + 0.05 * scale * random.uniform(-1, 1, scale.size),
        0.3 * scale * random.uniform(-1, 1, scale.size),
        scale,
    )


def evaluate(
    system: System, e: FloatArray, velocity: FloatArray, by: tuple[float, float] = (0.0, 0.0)
) -> tuple[tuple[float, float], FloatArray, FloatArray]:
    """Powers, force and tangent."""
    work = element_workspace(system)
    work.coordinates[0], work.coordinates[1] = e, velocity
    powers = add_hysteresis(system.hysteresis[0], system.vectors, *by, work)
    return powers, work.element.gradient, work.element.tangent


@pytest.mark.parametrize("by", [(1.0, 0.0), (0.0, 30.0), (0.7, 30.0)])
def test_tangent_is_the_slope_of_the_force(
    system: System, state: tuple[FloatArray, FloatArray, FloatArray], by: tuple[float, float]
) -> None:
    e, velocity, scale = state
    found = np.zeros((e.size, e.size))
    for column, move in enumerate(1e-7 * np.diag(scale)):
        forces = [evaluate(system, e + s * by[0] * move, velocity + s * by[1] * move)[1] for s in (1, -1)]
        found[:, column] = scale * (forces[0] - forces[1]) / 2e-7
    expected = scale[:, None] * evaluate(system, e, velocity, by)[2] * scale
    np.testing.assert_allclose(found, expected, atol=DIFFERENCES * np.abs(expected).max())


def test_power_is_that_of_the_force_and_never_negative(
    system: System, state: tuple[FloatArray, FloatArray, FloatArray]
) -> None:
    e, velocity, _ = state
    powers, force, _ = evaluate(system, e, velocity)
    assert min(powers) > 0.0
    assert sum(powers) == pytest.approx(force @ velocity, rel=1e-12)
    back = evaluate(system, e, -velocity)
    np.testing.assert_allclose(back[1], -force, rtol=1e-12)


@pytest.mark.parametrize("by", [(1.0, 0.0), (0.0, 30.0)])
def test_stretch_and_bending_add_up(
    system: System, state: tuple[FloatArray, FloatArray, FloatArray], by: tuple[float, float]
) -> None:
    """Also of belts that lose in one of them alone, whose other strain nothing asks for."""

    def without(*moduli: str) -> tuple[tuple[float, float], FloatArray, FloatArray]:
        rows: Records = system.hysteresis.copy().view(np.recarray)
        for modulus in moduli:
            rows[modulus] = 0.0
        return evaluate(system._replace(hysteresis=rows), *state[:2], by)

    both, stretch, bending = without(), without("bending"), without("axial")
    assert stretch[0][1] == bending[0][0] == 0.0
    for k in range(3):
        whole = np.asarray(both[k])
        np.testing.assert_allclose(np.add(stretch[k], bending[k]), whole, atol=1e-12 * np.abs(whole).max())


def test_rigid_motion_meets_no_resistance(system: System, state: tuple[FloatArray, FloatArray, FloatArray]) -> None:
    e, _, _ = state
    turning = np.stack([-e[1::2], e[::2]], axis=1)
    turning[:: e.size // 4] += (3.0, -4.0)
    _, force, _ = evaluate(system, e, 5.0 * turning.ravel())
    _, largest, _ = evaluate(system, e, np.roll(turning.ravel(), 2))
    np.testing.assert_allclose(force, 0.0, atol=1e-9 * np.abs(largest).max())


def test_strains_are_means_over_the_element(system: System) -> None:
    """A uniform stretch and an arc: modulus times strain beyond the reference, and times the change of the angle."""
    own, length = system.hysteresis[0], system.length[0]
    e = np.zeros(2 * len(system.scale))
    half = e.size // 2
    e[half], e[[2, half + 2]] = 1.05 * length, 1.05
    work = element_workspace(system)
    work.coordinates[0], work.coordinates[1] = e, 100.0 * e
    stress = hysteresis_tension(own, system.vectors, work)
    assert work.hysteresis.strain == pytest.approx(0.5 * (1.05**2 - 1.0) - 0.01, rel=1e-12)
    assert 0.0 < stress < own.axial * work.hysteresis.strain
    e[2:4], e[half + 2 : half + 4] = (np.cos(0.2), -np.sin(0.2)), (np.cos(0.3), np.sin(0.3))
    work.coordinates[0] = e
    hysteresis_tension(own, system.vectors, work)
    curvature = 0.5 / length
    assert work.hysteresis.curvature == pytest.approx(curvature, rel=1e-12)
    assert own.shortening > 0.0
    unbent: Records = system.hysteresis[:1].copy().view(np.recarray)
    unbent.shortening = 0.0
    straight = element_workspace(system)
    straight.coordinates[0], straight.coordinates[1] = work.coordinates[0], work.coordinates[1]
    hysteresis_tension(unbent[0], system.vectors, straight)
    difference = work.hysteresis.strain - straight.hysteresis.strain
    assert difference == pytest.approx(own.shortening * curvature**2, rel=1e-9)


def test_without_pulleys_strains_pass_from_element_to_element(drive: Drive) -> None:
    belt = drive.belt.replace(elements=8, stretch_loss_factor=0.08, bending_loss_factor=0.15)
    own = belt_system(belt).hysteresis
    np.testing.assert_allclose(own.stretch_length, belt.given_length / 8)
    assert not own.strain.any()


def test_a_belt_without_loss_factors_has_no_rows(drive: Drive) -> None:
    assert drive_system(prepare(drive)).hysteresis.size == 0
    assert blank(drive_system(prepare(drive)).hysteresis.dtype).axial == 0.0


def test_moduli_of_a_drive(drive: Drive) -> None:
    """Fixed centers: tensions lie on both sides of the tension at rest."""
    belt: Belt = drive.belt.replace(stretch_loss_factor=0.08, bending_loss_factor=0.15)
    own = drive_system(prepare(drive.replace(belt=belt))).hysteresis[0]
    assert own.axial == pytest.approx(STRETCH_SHARE * 0.08 * belt.axial_stiffness)
    assert own.bending == pytest.approx(BENDING_SHARE / 0.91 * 0.15 * belt.bending_stiffness)

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.elements.planar_curve import CREEPING, hysteretic
from beltdyn.model import Drive, install, prepare
from beltdyn.model.hysteresis import (
    SMOOTHED,
    bending_at_points,
    bending_resistance,
    compression_losses,
    passing_strains,
    rolling_resistances,
)
from beltdyn.theory.nip import BENDING_SHARE, STRETCH_SHARE, compression_loss, stretch_loss

MakeDrive = Callable[..., Drive]


def test_fixed_centres_strain_alike_to_both_sides(drive: Drive) -> None:
    passing = passing_strains(prepare(drive))
    tension = drive.belt.axial_stiffness * passing.strain * (1.0 + 2.0 * passing.strain) ** 0.5  # by Green's law
    assert tension == pytest.approx(install(drive).tension)
    assert passing.stretch_share == STRETCH_SHARE
    assert passing.stretch_length == pytest.approx(max(drive.radii / drive.frictions))


@pytest.mark.parametrize("speed", [10.0 * CREEPING, 3.0, 30.0])
@pytest.mark.parametrize(("ratio", "kept"), [(1.2, 0.998), (2.0, 0.968), (5.0, 0.848)])
def test_loss_of_a_sliding_arc(speed: float, ratio: float, kept: float) -> None:
    """Tensions T2 e^(mu s / R): pi/4 eta (T1 - T2)^2 / EA for the arcs of two pulleys, less what smoothing takes."""
    radius, friction, factor, slack, axial = 0.05, 1.0, 0.05, 100.0, 6e4
    tension = np.linspace(slack, ratio * slack, 2001)
    rate = friction * speed * tension / (radius * axial)
    strain = (tension - tension.mean()) / axial
    modulus = STRETCH_SHARE * factor * axial
    stress = [
        hysteretic(modulus, x, dx, speed**2, radius / friction).stress
        for x, dx in zip(strain.tolist(), rate.tolist(), strict=True)
    ]
    found = 2.0 * np.trapezoid(stress, strain) / stretch_loss(axial, factor, ratio * slack, slack)
    assert found == pytest.approx(kept, abs=2e-3)


@pytest.mark.parametrize("ratio", [0.03, 0.1, 0.3, 1.0, 3.0, 10.0])
def test_smoothing_is_made_up_for(drive: Drive, ratio: float) -> None:
    """Loss of the curvature exp(s / l), then 1, in means over elements of the length h, over 1/2: 1 within 2 %."""
    layer = (drive.belt.bending_stiffness / install(drive).tension) ** 0.5
    elements = max(3, round(drive.belt_length / (ratio * layer)))
    passing = passing_strains(prepare(drive))
    h = drive.belt_length / elements
    s = np.linspace(-12.0 * layer - h, 0.5 * h, 100_001)
    ends = s - 0.5 * h, s + 0.5 * h
    low, high = (np.where(at < 0.0, layer * np.exp(np.minimum(at, 0.0) / layer), layer + at) for at in ends)
    curvature = (high - low) / h
    slope = np.gradient(curvature, s)
    share = slope / np.hypot(slope, curvature / (passing.bending_length + SMOOTHED * h))
    loss = np.trapezoid(curvature * share * slope, s)
    assert passing.bending_share / BENDING_SHARE * loss == pytest.approx(0.5, rel=0.02)


def test_a_tensioner_holds_the_slack_side(make_drive: MakeDrive) -> None:
    spring = {"kind": "sliding", "pulley": "idler", "direction": (0.0, 1.0), "mass": 1.0, "preload": 300.0, "rate": 1e3}
    drive = make_drive("flat", tensioner=[spring], length=2.2)
    assert passing_strains(prepare(drive)).stretch_share == BENDING_SHARE


def test_bending_holds_the_belt_back_on_every_pulley(drive: Drive) -> None:
    """By pi/4 eta EI / R^2."""
    belt = drive.belt.replace(bending_loss_factor=0.2)
    expected = 0.05 * np.pi * belt.bending_stiffness * sum(1.0 / radius**2 for radius in drive.radii)
    assert bending_resistance(prepare(drive.replace(belt=belt))) == pytest.approx(expected)
    assert bending_resistance(prepare(drive)) == 0.0


def test_rolling_resistance_along_the_arc_takes_the_loss_of_compression(drive: Drive) -> None:
    """A meter of belt that passes the arc under the tension at rest: rho T phi."""
    belt, tension = drive.belt.replace(compression_loss_factor=0.5, contact_stiffness=2e7), install(drive).tension
    pressed = drive.replace(belt=belt)
    expected = compression_loss(tension, belt.bending_stiffness, 2e7, 0.5, drive.radii)
    np.testing.assert_allclose(compression_losses(prepare(pressed)), expected)
    np.testing.assert_allclose(rolling_resistances(prepare(pressed)) * tension * drive.path.wrap_angles, expected)
    assert not rolling_resistances(prepare(drive)).any()


def test_coefficients_of_losses_end_with_the_rated_tension(drive: Drive) -> None:
    """Beyond it they stay; below it they grow with the tension."""
    belt = drive.belt.replace(length=None, compression_loss_factor=0.3, contact_stiffness=1e7, largest_tension=100.0)
    found = [
        rolling_resistances(prepare(drive.replace(belt=belt.replace(installed_tension=tension))))
        for tension in (50.0, 100.0, 300.0)
    ]
    assert np.all(found[0] < 0.9 * found[1])
    np.testing.assert_allclose(found[2], found[1], rtol=0.02)  # the wrap of a belt that sinks deeper


def test_only_grooves_compress(make_drive: MakeDrive) -> None:
    drive = make_drive("flat")
    pressed = drive.replace(belt=drive.belt.replace(compression_loss_factor=0.5, contact_stiffness=2e7))
    inside = np.array([pulley.side == "inside" for pulley in drive.pulleys])
    assert 0 < inside.sum() < inside.size
    np.testing.assert_array_equal(rolling_resistances(prepare(pressed)) > 0.0, inside)


def test_at_points_the_whole_loss_is_left(drive: Drive) -> None:
    """Of the curvature exp(s / l), then 1, as on a stiff pulley; softer ones leave less: 1/2 within 2 %."""
    lossy = drive.replace(belt=drive.belt.replace(bending_loss_factor=0.2))
    layer = (drive.belt.bending_stiffness / install(drive).tension) ** 0.5
    modulus, length = bending_at_points(prepare(lossy))
    share = modulus / (BENDING_SHARE * 0.2 * drive.belt.bending_stiffness)
    s = np.linspace(-20.0 * layer, 0.0, 10_001)
    curvature = np.exp(s / layer)
    slope = curvature / layer
    loss = np.trapezoid(curvature * slope * slope / np.hypot(slope, curvature / length), s)
    assert loss == pytest.approx(0.5 / np.hypot(1.0, layer / length), rel=1e-5)
    assert share * loss == pytest.approx(0.5, rel=0.02)

"""The lumped drive against closed forms."""

from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive, Prepared, prepare
from beltdyn.vibration.peaks import LumpedDrive, lumped_drive

TENSION = 400.0
CREEP = 6e-4
"""Slip velocity of saturation over the speed of the rim."""
STIFF = {"width": 0.02, "thickness": 1e-3, "axial_stiffness": 1e5, "bending_stiffness": 1e-6, "mass_per_length": 1e-6}


def lumps(speed: float = 0.0, belt: dict[str, float] | None = None, **driven: object) -> LumpedDrive:
    """A crank and a rotor of equal radii, with equal tensions."""
    pulleys = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.05, "speed": 1.0},
        {"name": "rotor", "center": [0.4, 0.0], "radius": 0.05, "inertia": 0.002} | driven,
    ]
    given = STIFF | {"installed_tension": TENSION} | (belt or {})
    prepared = prepare(
        Drive(belt=given, pulley=pulleys, contact={"friction": 0.8, "creep_ratio": CREEP}, simulation={"duration": 1.0})
    )
    rest = prepared.installation
    return lumped_drive(prepared, rest.span_tensions, rest.path.centers, np.zeros(0), speed)


def rate(lumped: LumpedDrive) -> float:
    """Stiffness of both spans at the rotor, N m/rad."""
    return 0.05**2 * float(lumped.spans.sum())


def test_a_rotor_on_two_spans() -> None:
    lumped = lumps()
    (mode,) = lumped.modes(3)
    assert lumped.spans[0] == pytest.approx((1e5 + TENSION) / 0.4, rel=1e-3)
    assert mode.frequency == pytest.approx(np.sqrt(rate(lumped) / 0.002) / (2.0 * np.pi), rel=1e-3)
    assert abs(mode.damping_ratio) < 1e-6
    assert mode.shares[1] == pytest.approx(1.0)


def test_a_hub_chain_has_two_modes() -> None:
    link = {"kind": "isolator", "stiffness": 300.0, "inertia": 0.004}
    lumped = lumps(hub=[link])
    stiffness = np.array([[rate(lumped) + 300.0, -300.0], [-300.0, 300.0]])
    expected = np.sqrt(np.sort(np.linalg.eigvals(stiffness / np.array([[0.002], [0.004]])).real)) / (2.0 * np.pi)
    np.testing.assert_allclose([one.frequency for one in lumped.modes(4)], expected, rtol=1e-3)


def test_strain_that_flows_with_the_belt_damps_rotation() -> None:
    """T' = k e' - v / l (T - T_before(t - a / v)) of two equal spans, whose changes are opposite: T_before = -T.

    Creep on the arc smears what passes, as exp(r a) with T' + v T_x = v b T_xx.
    """
    speed, arc = 20.0, np.pi * 0.05
    lumped = lumps(speed)
    decay, k = speed * lumped.spans[0] / (1e5 + TENSION), rate(lumped) / 0.002
    layer = 0.05 * 1e5 * CREEP / (0.8 * TENSION)
    swing = 1j * np.sqrt(k)
    for _ in range(50):
        passed = np.exp(arc * (1.0 - np.sqrt(1.0 + 4.0 * swing * layer / speed)) / (2.0 * layer))
        swing = 1j * np.sqrt(k * swing / (swing + decay * (1.0 + passed)))
    (mode,) = lumped.modes(3)
    assert lumped.delay == pytest.approx(arc / speed, rel=2e-3)
    assert mode.frequency == pytest.approx(swing.imag / (2.0 * np.pi), rel=2e-3)
    assert mode.damping_ratio == pytest.approx(-swing.real / abs(swing), rel=2e-2)


def test_waves_of_strain_pass_in_modes_and_answers_alike() -> None:
    """The root of a mode is a pole of the answer."""
    lumped = lumps(20.0)
    (mode,) = lumped.modes(3)
    swing = 2.0 * np.pi * mode.frequency * (1.0 + 1j * mode.damping_ratio / np.sqrt(1.0 - mode.damping_ratio**2))
    near, far = (abs(lumped.answer(swing * away, {}, {1: 1.0})[1][1]) for away in (1.0 + 1e-4, 1.1))
    assert near > 500.0 * far


def test_the_answer_to_a_crank_is_that_of_one_degree_of_freedom() -> None:
    lumped = lumps()
    k, frequency = rate(lumped), 0.6 * np.sqrt(rate(lumped) / 0.002)
    tension, moved = lumped.answer(frequency, {0: 0.01}, {})
    rotor = k * 0.01 / (k - frequency**2 * 0.002)
    assert moved[1] == pytest.approx(rotor, rel=1e-3)
    assert tension[0] == pytest.approx(lumped.spans[0] * 0.05 * (rotor - 0.01), rel=2e-3)
    torque = lumped.answer(frequency, {}, {1: 1.0})[1]
    assert torque[1] == pytest.approx(1.0 / (k - frequency**2 * 0.002), rel=1e-3)


def test_bending_lifts_the_belt_off_the_ends_of_arcs() -> None:
    lumped = lumps(belt={"bending_stiffness": 0.04})
    reach = np.sqrt(0.04 / TENSION)
    assert lumped.spans[0] == pytest.approx((1e5 + TENSION) / (0.4 + 2.0 * reach), rel=1e-3)


def three(mirrored: bool = False, tensioner: dict[str, object] | None = None) -> Prepared:
    """A crank and two rotors of unequal radii, or its mirror image."""
    pulleys: list[dict[str, Any]] = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.05, "speed": 1.0},
        {"name": "rotor", "center": [0.4, 0.0], "radius": 0.03, "inertia": 2e-4},
        {"name": "idler", "center": [0.15, 0.3], "radius": 0.04, "inertia": 5e-4, "mass": 0.3},
    ]
    pulleys[0]["harmonics"] = [{"order": 2, "amplitude": 0.02}] if tensioner else []
    if mirrored:
        pulleys = [one | {"center": [-one["center"][0], one["center"][1]]} for one in reversed(pulleys)]
    belt = STIFF | {"installed_tension": TENSION, "mass_per_length": 0.2, "bending_stiffness": 0.01}
    contact = {"friction": 0.8, "creep_ratio": CREEP}
    tensioners = [tensioner] if tensioner else []
    return prepare(
        Drive(belt=belt, pulley=pulleys, tensioner=tensioners, contact=contact, simulation={"duration": 1.0})
    )


def test_belt_and_rotors_that_run_together_have_their_kinetic_energy() -> None:
    prepared = three()
    path, belt = prepared.path, prepared.belt
    lumped = lumped_drive(prepared, np.full(3, TENSION), path.centers, np.zeros(0), 0.0)
    speeds = 2.0 / path.radii
    rotors = 2e-4 * speeds[1] ** 2 + 5e-4 * speeds[2] ** 2
    assert speeds @ lumped.mass @ speeds == pytest.approx(belt.mass_per_length * path.length * 2.0**2 + rotors)
    np.testing.assert_allclose(lumped.stretches @ speeds, 0.0, atol=1e-12)


def test_a_drive_that_runs_backwards_is_the_mirror_image_of_one_that_runs_forwards() -> None:
    """Spans by their pulleys: from the crank, between the rotors, and to the crank."""
    tension, found = np.array([500.0, 250.0, 300.0]), []
    for mirrored, order, speed in ((False, [0, 1, 2], 20.0), (True, [1, 0, 2], -20.0)):
        prepared = three(mirrored)
        lumped = lumped_drive(prepared, tension[order], prepared.path.centers, np.zeros(0), speed)
        crank = 2 if mirrored else 0
        answer = lumped.answer(400.0, {crank: 0.01}, {})[0]
        modes = [(one.frequency, one.damping_ratio) for one in lumped.modes(2)]
        found.append((np.abs(answer[order]), np.array(modes), lumped.passing[order]))
        other = lumped_drive(prepared, tension[order], prepared.path.centers, np.zeros(0), -speed)
        assert abs(other.modes(2)[0].damping_ratio / modes[0][1] - 1.0) > 1e-3
    for there, back in zip(*found, strict=True):
        np.testing.assert_allclose(there, back, rtol=1e-7)


SLIDE = {"kind": "sliding", "pulley": "idler", "direction": [0.0, 1.0], "mass": 0.5, "preload": 700.0, "rate": 2e4}
SLIDE |= {"stops": [-2e-3, 3e-3], "stop_stiffness": 1e6, "creep_speed": 1e-4}


@pytest.mark.parametrize(("position", "stopped"), [(-2.1e-3, True), (-1.9e-3, False), (2.9e-3, False), (3.1e-3, True)])
def test_a_stop_stiffens_a_tensioner_that_has_reached_it(position: float, stopped: bool) -> None:
    prepared = three(tensioner=SLIDE)
    free, there = (
        lumped_drive(prepared, np.full(3, TENSION), prepared.path.centers, np.array([at]), 5.0)
        for at in (0.0, position)
    )
    assert there.owners[-1] == "slide of idler"
    assert there.stiffness[-1, -1] - free.stiffness[-1, -1] == pytest.approx(1e6 if stopped else 0.0)

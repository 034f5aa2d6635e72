"""The lumped drive against closed forms."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.points.quasi_steady import Running
from beltdyn.vibration.excitation import speed_waves
from beltdyn.vibration.peaks import LumpedDrive, amplitudes, excitations_of, lumped_drive

TENSION = 400.0
CREEP = 6e-4
"""Slip velocity of saturation over the speed of the rim."""
STIFF = {"width": 0.02, "thickness": 1e-3, "axial_stiffness": 1e5, "bending_stiffness": 1e-6, "mass_per_length": 1e-6}


def lumps(
    speed: float = 0.0,
    belt: dict[str, float] | None = None,
    contact: dict[str, object] | None = None,
    tensions: FloatArray | None = None,
    **driven: object,
) -> LumpedDrive:
    """A crank and a rotor of equal radii, with equal tensions unless others are given."""
    pulleys = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.05, "speed": 1.0},
        {"name": "rotor", "center": [0.4, 0.0], "radius": 0.05, "inertia": 0.002} | driven,
    ]
    given = STIFF | {"installed_tension": TENSION} | (belt or {})
    law = contact or {"friction": 0.8, "creep_ratio": CREEP}
    prepared = prepare(Drive(belt=given, pulley=pulleys, contact=law, simulation={"duration": 1.0}))
    rest = prepared.installation
    tensions = rest.span_tensions if tensions is None else tensions
    return lumped_drive(prepared, tensions, rest.path.centers, np.zeros(0), speed)


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


@pytest.mark.parametrize("links", [1, 2])
def test_a_hub_chain_has_a_mode_for_each_body(links: int) -> None:
    """With the shares of the bodies in the kinetic energy."""
    link = {"kind": "isolator", "stiffness": 300.0, "inertia": 0.004}
    lumped = lumps(hub=[link] * links)
    stiffness, mass = np.zeros((links + 1, links + 1)), np.diag([0.002] + [0.004] * links)
    stiffness[0, 0] = rate(lumped)
    for number in range(links):
        stiffness[number : number + 2, number : number + 2] += 300.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    squares, shapes = eigh(stiffness, mass)
    modes = lumped.modes(4)
    np.testing.assert_allclose([one.frequency for one in modes], np.sqrt(squares) / (2.0 * np.pi), rtol=1e-3)
    for mode, shape in zip(modes, shapes.T, strict=True):
        np.testing.assert_allclose(mode.shares[1:], np.diag(mass) * shape**2, atol=1e-3)


def test_a_damped_chain_swings_as_two_bodies_on_springs_and_a_damper() -> None:
    """Roots of (M s^2 + C s + K) x = 0; at standstill nothing else damps."""
    lumped = lumps(hub=[{"kind": "isolator", "stiffness": 300.0, "damping": 0.3, "inertia": 0.004}])
    link, mass = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.diag([0.002, 0.004])
    stiffness = 300.0 * link + np.diag([rate(lumped), 0.0])
    inverse = np.linalg.inv(mass)
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -0.3 * inverse @ link]])
    roots = np.linalg.eigvals(first_order)
    roots = roots[roots.imag > 0.0]
    roots = roots[np.argsort(roots.imag)]
    modes = lumped.modes(4)
    np.testing.assert_allclose([one.frequency for one in modes], roots.imag / (2.0 * np.pi), rtol=1e-3)
    np.testing.assert_allclose([one.damping_ratio for one in modes], -roots.real / np.abs(roots), rtol=2e-3)


def test_a_load_damps_its_shaft_by_its_slope_while_it_turns() -> None:
    load = {"kind": "resistance", "linear": 0.05, "quadratic": 1e-4}
    for speed, slope in ((20.0, 0.05 + 2e-4 * 20.0 / 0.05), (0.0, 0.0)):
        assert lumps(speed, load=[load]).damping[1, 1] == pytest.approx(slope)


@pytest.mark.parametrize("law", ["relative_creep", "force_slope"])
def test_strain_that_flows_with_the_belt_damps_rotation(law: str) -> None:
    """T' = k e' - v / l (T - T_before(t - a / v)) of two equal spans, whose changes are opposite: T_before = -T.

    Creep on the arc smears what passes, as exp(r a) with T' + v T_x = v b T_xx.
    """
    speed, arc = 20.0, np.pi * 0.05
    slope = {"friction_law": law, "friction": 0.8, "creep_rate_factor": 0.8 * TENSION / 0.05 / (CREEP * speed)}
    lumped = lumps(speed, contact=slope if law == "force_slope" else None)
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


@pytest.mark.parametrize("friction", [0.8, 0.02, 1.5e-3])
def test_strain_waits_while_it_passes_where_the_arc_adheres(friction: float) -> None:
    """By Euler half of an arc slides where the tensions differ by half of what its friction holds, however small."""
    tensions = TENSION * np.exp(np.array([0.5, 0.0]) * np.pi * friction)
    lumped = lumps(20.0, contact={"friction": friction, "creep_ratio": CREEP}, tensions=tensions)
    assert lumped.delay == pytest.approx(0.5 * np.pi * 0.05 / 20.0, rel=2e-3)


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


def three(mirrored: bool = False, tensioners: Sequence[dict[str, Any]] = ()) -> Prepared:
    """A crank and two rotors of unequal radii, or its mirror image; a crank with tensioners turns unevenly."""
    pulleys: list[dict[str, Any]] = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.05, "speed": 1.0},
        {"name": "rotor", "center": [0.4, 0.0], "radius": 0.03, "inertia": 2e-4},
        {"name": "idler", "center": [0.15, 0.3], "radius": 0.04, "inertia": 5e-4, "mass": 0.3},
    ]
    pulleys[0]["harmonics"] = [{"order": 2, "amplitude": 0.02}] if tensioners else []
    if mirrored:
        pulleys = [one | {"center": [-one["center"][0], one["center"][1]]} for one in reversed(pulleys)]
    belt = STIFF | {"installed_tension": TENSION, "mass_per_length": 0.2, "bending_stiffness": 0.01}
    contact = {"friction": 0.8, "creep_ratio": CREEP}
    return prepare(
        Drive(belt=belt, pulley=pulleys, tensioner=list(tensioners), contact=contact, simulation={"duration": 1.0})
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
SLIDE |= {"stops": [-2e-3, 3e-3], "stop_stiffness": 1e6}
OTHER = {"kind": "sliding", "pulley": "rotor", "direction": [1.0, 0.0], "mass": 0.5, "preload": 700.0, "rate": 2e4}


@pytest.mark.parametrize(("position", "stopped"), [(-2.1e-3, True), (-1.9e-3, False), (2.9e-3, False), (3.1e-3, True)])
def test_a_stop_stiffens_the_tensioner_that_has_reached_it(position: float, stopped: bool) -> None:
    prepared = three(tensioners=[OTHER, SLIDE])
    free, there = (
        lumped_drive(prepared, np.full(3, TENSION), prepared.path.centers, np.array([0.0, at]), 5.0)
        for at in (0.0, position)
    )
    assert there.owners[-2:] == ("slide of rotor", "slide of idler")
    added = np.zeros_like(there.stiffness)
    added[-1, -1] = 1e6 if stopped else 0.0
    np.testing.assert_allclose(there.stiffness - free.stiffness, added, atol=1e-6)


def moved(tensioning: float, yielding: float) -> float:
    """Amplitude of a slide with dry friction under the harmonic of the crank, m."""
    rubbed = SLIDE | {"tensioning_friction": tensioning, "yielding_friction": yielding, "creep_speed": 1e-6}
    prepared = three(tensioners=[rubbed])
    hub, none = np.tile([1.0, 0.0], (1, 3, 1)), np.zeros((1, 3))
    tension = np.full((1, 3), TENSION)
    states = Running(
        *(np.array([5.0]), none, none, tension, np.stack([tension, tension], axis=2)),
        *(np.zeros((1, 1)), prepared.path.centers[None], hub),
    )
    excitations = excitations_of(prepared.drive, 0)
    found = amplitudes(prepared, prepared.drive, excitations, states, 0)
    if tensioning == yielding == 0.0:
        lumped = lumped_drive(prepared, tension[0], prepared.path.centers, np.zeros(1), 5.0)
        answer = lumped.answer(2.0 * 5.0 / 0.05, {0: speed_waves(prepared.drive, 0)[2.0]}, {})
        assert found.positions == pytest.approx(np.abs(answer[1][-1:]))
        np.testing.assert_allclose(found.tension, np.abs(answer[0]))
    return float(found.positions[0])


def test_dry_friction_counts_with_the_mean_of_both_senses() -> None:
    """And the more there is, the less the slide moves."""
    free = moved(0.0, 0.0)
    even = moved(0.2, 0.2)
    assert moved(0.4, 0.0) == pytest.approx(even, rel=1e-9)
    assert moved(0.0, 0.4) == pytest.approx(even, rel=1e-9)
    assert moved(20.0, 20.0) < even < free

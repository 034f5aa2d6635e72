"""Small motions of a drive under motions of its driver and torques on the driven pulley."""

import numpy as np
import pytest

from beltdyn.model import Drive, example
from beltdyn.points.changed_drive import driver_of
from beltdyn.results import Run
from beltdyn.state.steady import steady_state
from beltdyn.vibration.response_answers import Answers, Excited, ForcedMotion
from validation.published.cases import better, loaded_two_pulley

RADIUS, INERTIA = 0.08125, 0.25


@pytest.fixture(scope="module")
def run() -> Run:
    return steady_state(better(loaded_two_pulley()))


@pytest.fixture(scope="module")
def motion(run: Run) -> ForcedMotion:
    return ForcedMotion(run, stuck=False)


def test_slow_motions_turn_all_alike(motion: ForcedMotion) -> None:
    """With the load that stays, the velocity of slip stays too, so that pulleys of one radius change alike."""
    found = motion.answer(Excited(0.01, {0: 1.0}, {}))
    assert found["pulley_speed"][0] == pytest.approx(0.01j)
    assert found["pulley_speed"][1] / found["pulley_speed"][0] == pytest.approx(1.0, rel=1e-3)
    np.testing.assert_array_equal(found["pulley_speed"], found["shaft_speed"])


def test_fast_motions_leave_the_heavy_pulley_behind(motion: ForcedMotion) -> None:
    found = motion.answer(Excited(1e4, {0: 1.0}, {}))
    assert abs(found["pulley_speed"][1]) < 1e-2 * abs(found["pulley_speed"][0])


@pytest.mark.parametrize("frequency", [50.0, 300.0])
def test_torques_balance(motion: ForcedMotion, run: Run, frequency: float) -> None:
    """The driver gives what the belt takes; on the driven pulley belt, load and inertia are in balance."""
    inertia = run.drive.pulleys[1].inertia
    found = motion.answer(Excited(frequency, {0: 1e-3}, {1: 2.0}))
    belt, shaft = found["pulley_torque"], found["shaft_torque"]
    driver_inertia = run.drive.pulleys[0].inertia * 1j * frequency * found["pulley_speed"][0]
    assert belt[0] + shaft[0] == pytest.approx(driver_inertia, abs=1e-3 * abs(shaft[0]))
    assert shaft[1] == pytest.approx(2.0)
    assert belt[1] + shaft[1] == pytest.approx(inertia * 1j * frequency * found["pulley_speed"][1], rel=1e-3)


def test_it_is_linear(motion: ForcedMotion) -> None:
    one, other = motion.answer(Excited(150.0, {0: 1e-3}, {})), motion.answer(Excited(150.0, {}, {1: 2.0}))
    both = motion.answer(Excited(150.0, {0: 3e-3}, {1: 2.0j}))
    for name in ("span_tension", "hub_load", "mid_span_displacement", "pulley_speed"):
        sum_of_both, size = 3.0 * one[name] + 1j * other[name], float(np.abs(both[name]).max())
        np.testing.assert_allclose(sum_of_both, both[name], rtol=1e-3, atol=1e-3 * size)


SLIDE = {"kind": "sliding", "pulley": "idler", "direction": [0.0, 1.0], "mass": 0.5}
CREEPING = 1e-9
"""Speed over which dry friction builds up, m/s: far below those of the vibrations."""


@pytest.fixture(scope="module")
def tensioned() -> Run:
    """A crank and a rotor, with an idler on a slide."""
    pulleys = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.05, "speed": 60.0},
        {"name": "rotor", "center": [0.4, 0.0], "radius": 0.05, "inertia": 2e-3, "torque": -5.0},
        {"name": "idler", "center": [0.2, 0.25], "radius": 0.04, "inertia": 3e-4, "mass": 0.3},
    ]
    belt = {"width": 0.02, "thickness": 2e-3, "axial_stiffness": 1e5, "bending_stiffness": 0.02, "mass_per_length": 0.1}
    given = belt | {"installed_tension": 400.0}
    contact = {"friction": 0.8, "creep_ratio": 0.01}
    slide = SLIDE | {"preload": 700.0, "rate": 2e4}
    simulation = {"duration": 1.0}
    return steady_state(Drive(belt=given, pulley=pulleys, tensioner=[slide], contact=contact, simulation=simulation))


def with_slide(run: Run, **changes: float) -> ForcedMotion:
    """The same steady running, which nothing of these depends on."""
    (slide,) = run.drive.tensioners
    return ForcedMotion(Run(run.dataset, run.drive.replace(tensioner=[slide.replace(**changes)])), stuck=False)


def test_dry_friction_does_what_a_damper_of_the_same_work_does(tensioned: Run) -> None:
    """A damper c takes as much in a period as friction c pi V / 4, V the largest velocity; and much friction holds."""
    excited = Excited(150.0, {0: 1e-3}, {})
    free, damped = with_slide(tensioned), with_slide(tensioned, damping=2e3)
    without, slowed = free.answer(excited), damped.answer(excited)
    friction = 2e3 * np.pi * 150.0 * abs(slowed["tensioner_position"][0]) / 4.0
    assert abs(slowed["tensioner_position"][0]) < 0.9 * abs(without["tensioner_position"][0])
    held = ForcedMotion(with_friction(tensioned, 1.0), stuck=True).answer(excited)
    for size, expected in ((1e-9 * friction, without), (friction, slowed), (1e6 * friction, held)):
        rubbing = ForcedMotion(with_friction(tensioned, size), stuck=False)
        found = rubbing.range_of([excited], [without]).friction_change
        change = np.abs(np.abs(expected["span_tension"]) - np.abs(without["span_tension"])).max()
        assert found == pytest.approx(change / np.abs(without["span_tension"]).max(), rel=0.01, abs=1e-6)


def with_friction(run: Run, friction: float) -> Run:
    """With more of it while the belt is tensioned than while it yields."""
    (slide,) = run.drive.tensioners
    rubbed = slide.replace(tensioning_friction=1.5 * friction, yielding_friction=0.5 * friction, creep_speed=CREEPING)
    return Run(run.dataset, run.drive.replace(tensioner=[rubbed]))


def test_tensioners_have_the_unit_of_their_motion(tensioned: Run) -> None:
    for drive, unit in ((tensioned.drive, "m"), (example("alternator_drive"), "rad")):
        waves = [{"order": 2, "amplitude": 0.01}]
        pulleys = [one.replace(harmonics=waves) if one.prescribed else one for one in drive.pulleys]
        shaken = drive.replace(pulley=pulleys)
        variables = Answers(shaken, driver_of(shaken), np.array([10.0])).variables()
        for name in ("tensioner_position_amplitude", "largest_tensioner_position_amplitude"):
            assert variables[name][0].units == unit

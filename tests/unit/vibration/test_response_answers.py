"""Small motions of a drive under motions of its driver and torques on the driven pulley."""

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.state.steady import steady_state
from beltdyn.vibration.response_answers import Excited, ForcedMotion
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

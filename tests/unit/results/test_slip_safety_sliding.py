"""How far a belt slides on pulleys: whole arcs, parts of them, and what only creeps."""

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.results.slip_safety import sliding_of_pulleys

POINTS = 8
"""Two free ones, three on the first pulley, three on the second."""
TOUCHED = np.array([[-1, 0, 0, 0, -1, 1, 1, 1]])
PRESSED = np.where(TOUCHED >= 0, 200.0, 0.0)


def summed(drive: Drive, beyond: list[float], normal: np.ndarray = PRESSED) -> tuple[list[float], list[float]]:
    """Speeds and shares where points are by so much faster than the belt creeps, m/s, in their sense; 0 sticks."""
    creep = drive.friction_parameters.saturation(normal, drive.frictions[TOUCHED], 0.0)
    velocity = np.sign(beyond) * creep + np.array([beyond])
    coordinate = (np.arange(POINTS) + 0.5) * drive.belt_length / POINTS
    found = sliding_of_pulleys(prepare(drive), coordinate, TOUCHED, normal, velocity, np.zeros((1, 2)))
    speed, share = found["sliding_speed"][0], found["sliding_share"][0]
    return speed.tolist(), share.tolist()


def test_an_arc_that_slides_as_a_whole_slides_at_its_slowest_point(drive: Drive) -> None:
    speed, share = summed(drive, [0.0, 0.3, 0.1, 0.2, 0.0, -0.4, -0.4, -0.5])
    assert speed == pytest.approx([0.1, -0.4])
    assert share == pytest.approx([1.0, 1.0])


def test_an_arc_that_creeps_somewhere_does_not_slide(drive: Drive) -> None:
    speed, share = summed(drive, [0.0, 0.3, 0.0, 0.2, 0.0, -0.4, -0.4, 0.5])
    assert speed == [0.0, 0.0]
    assert share == pytest.approx([2.0 / 3.0, 1.0])


def test_points_that_do_not_press_or_are_free_do_not_count(drive: Drive) -> None:
    lifted = PRESSED.copy()
    lifted[0, 2] = 0.0
    speed, share = summed(drive, [5.0, 0.3, 0.0, 0.2, 5.0, 0.0, 0.0, 0.1], lifted)
    assert speed == pytest.approx([0.2, 0.0])
    assert share == pytest.approx([1.0, 1.0 / 3.0])


def test_a_belt_that_touches_nothing_slides_nowhere(drive: Drive) -> None:
    assert summed(drive, [5.0] * POINTS, np.zeros_like(PRESSED)) == ([0.0, 0.0], [0.0, 0.0])

"""Where straight lines meet."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.vibration.campbell import CampbellDiagram, crossings

SPEED = np.array([1.0, 2.0, 3.0, 4.0])


def test_lines_meet_once() -> None:
    """A mode at 2.5 Hz and one that falls as 6 - s meet the order s at 2.5 and at 3."""
    modes = np.column_stack([np.full(4, 2.5), 6.0 - SPEED])
    damping = np.column_stack([0.01 * SPEED, np.full(4, 0.2)])
    first, second = crossings(SPEED, modes, damping, SPEED[:, None])
    assert (first.speed, first.frequency, first.mode, first.line) == pytest.approx((2.5, 2.5, 0, 0))
    assert first.damping_ratio == pytest.approx(0.025)
    assert (second.speed, second.frequency, second.mode) == pytest.approx((3.0, 3.0, 1))


@pytest.mark.parametrize("end", [0, 3])
def test_they_meet_at_an_end(end: int) -> None:
    (found,) = crossings(SPEED, np.full((4, 1), SPEED[end]), np.zeros((4, 1)), SPEED[:, None])
    assert found.speed == SPEED[end]


def test_nothing_is_said_of_what_is_not_known() -> None:
    """Between 2 and 4 the mode is known at 2 and 4 alone."""
    mode = np.array([[2.9], [2.9], [np.nan], [2.9]])
    assert crossings(SPEED, mode, np.zeros((4, 1)), SPEED[:, None]) == []


def test_parts_are_those_at_the_nearest_speed_at_which_the_mode_is_known(drive: Drive) -> None:
    diagram = CampbellDiagram(drive, SPEED, [], 2, stuck=False)
    modes: Any = SimpleNamespace(frequency=np.array([[5.0, 9.0], [5.0, np.nan], [5.0, 9.0], [5.0, np.nan]]))
    assert [diagram._nearest(speed, modes, 0) for speed in (1.2, 2.4, 2.6, 3.9)] == [0, 1, 2, 3]
    assert [diagram._nearest(speed, modes, 1) for speed in (1.2, 2.4, 2.6, 3.9)] == [0, 2, 2, 2]


def test_lines_that_do_not_meet() -> None:
    assert crossings(SPEED, np.full((4, 1), 9.0), np.zeros((4, 1)), SPEED[:, None]) == []

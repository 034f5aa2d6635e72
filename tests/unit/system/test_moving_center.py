"""Carriers of prescribed speed: where they put centers, and that places stay as they are."""

import numpy as np
import pytest

from beltdyn.kernel import interpreted
from beltdyn.model import Drive, prepare
from beltdyn.system.build import drive_system
from beltdyn.system.moving_center import moving_to, pulley_center, pulley_state, with_movers
from beltdyn.system.state import State, laid


def test_a_center_moves_at_constant_speed_to_its_place(drive: Drive) -> None:
    given = drive_system(prepare(drive))
    system, still = with_movers(given, [1]), laid(given, drive.path)
    longer = State(*(np.append(one, 0.0) for one in (still.position, still.velocity, still.acceleration)))
    system, state = moving_to(system, longer, 0, {1: (0.7, 0.1)}, 0.5)
    before = np.array(pulley_center(given, 1, still.position))
    assert pulley_center(system, 1, state.position) == pytest.approx(before)
    seen = interpreted(pulley_state)(system, 1, state.position, state.velocity)
    assert (seen.velocity_x, seen.velocity_y) == pytest.approx((np.array([0.7, 0.1]) - before) / 0.5)
    reached = state.position.copy()
    reached[-1] += 0.5 * state.velocity[-1]
    assert pulley_center(system, 1, reached) == pytest.approx((0.7, 0.1))
    assert pulley_center(system, 0, reached) == pulley_center(given, 0, still.position)
    system, state = moving_to(system, State(reached, state.velocity, state.acceleration), 0, {}, 0.5)
    assert pulley_center(system, 1, state.position) == pytest.approx((0.7, 0.1))
    assert state.velocity[-1] == 0.0

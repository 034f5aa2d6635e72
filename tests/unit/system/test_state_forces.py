"""The motion of prescribed shafts in a state."""

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.system.arrays import Motion
from beltdyn.system.build import belt_system
from beltdyn.system.state_forces import prescribe


def test_prescribe_writes_prescribed_pulleys_only(drive: Drive) -> None:
    system = belt_system(drive.belt, drive.pulleys, drive.contact, "shared_node")
    position, velocity, acceleration = np.full((3, 6 * system.nodes + 2), 7.0)
    prescribe(system, Motion(0.325, position, velocity, acceleration))
    assert position[-2:] == pytest.approx([6.0 * 0.275 / 2.0, 7.0])
    assert velocity[-2:] == pytest.approx([6.0, 7.0])
    assert acceleration[-2:] == pytest.approx([12.0 / 0.55, 7.0])
    assert np.all(position[:-2] == 7.0)
    assert np.all(velocity[:-2] == 7.0)
    assert np.all(acceleration[:-2] == 7.0)

"""When a run-up ends because a pulley slips through."""

import numpy as np
import pytest

from beltdyn.errors import SlipError
from beltdyn.model import Drive, prepare
from beltdyn.observation.observer import SlipThrough


def outputs(drive: Drive, times: list[float], sliding: float) -> dict[str, np.ndarray]:
    """The driver turns at 20 rad/s, and the driven pulley slides."""
    ones = np.ones((len(times), 2))
    return {
        "time": np.array(times),
        "sliding_speed": sliding * ones * [0.0, 1.0],
        "pulley_speed": 20.0 * ones,
        "pulley_torque": ones * [-3.0, 3.0],
        **dict.fromkeys(("span_tension", "span_tension_at_start", "span_tension_at_end"), ones * [80.0, 40.0]),
    }


def test_sliding_for_a_turn_of_the_belt_ends_it(drive: Drive) -> None:
    rim = 20.0 * float(drive.radii[0])
    turn = drive.belt_length / rim
    watch = SlipThrough(prepare(drive), 0)
    watch(outputs(drive, [0.0, 0.9 * turn], 0.1 * rim))
    with pytest.raises(SlipError, match=r"driven is in gross slip.*10% of the rim speed of driver.*3 N m.*80 and 40 N"):
        watch(outputs(drive, [1.1 * turn], 0.1 * rim))


def test_short_or_slow_sliding_does_not(drive: Drive) -> None:
    rim = 20.0 * float(drive.radii[0])
    turn = drive.belt_length / rim
    watch = SlipThrough(prepare(drive), 0)
    for number in range(4):
        watch(outputs(drive, [number * 0.9 * turn], 0.1 * rim))
        watch(outputs(drive, [(number + 0.5) * 0.9 * turn], 0.0))
    watch(outputs(drive, [10.0 * turn, 20.0 * turn], 0.04 * rim))

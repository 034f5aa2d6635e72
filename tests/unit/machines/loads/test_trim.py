"""Trims from a dancer or a load cell: limits, derivatives by all that they feel, and what is measured."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import blank, fill
from beltdyn.kernel import interpreted
from beltdyn.machines.loads.load import LOADS, ShaftState
from beltdyn.machines.loads.trim import Trim
from beltdyn.model import SlidingTensioner, SpeedTrim, TorqueTrim

PI: dict[str, Any] = {"sensor": "dancer", "position_gain": 2.0, "integral_time": 0.5}
SPEED = SpeedTrim(kind="speed_trim", speed={"kind": "constant", "value": 50.0}, speed_gain=3.0, **PI)
TORQUE = TorqueTrim(kind="torque_trim", torque={"kind": "constant", "value": -30.0}, largest_trim=0.1, **PI)
SHAFT = ShaftState(0.0, 0.3, 40.0, 50.0, 0.02, 0.01)
"""A trim of 0.06: gain times error and state over the integral time."""
CELL = SlidingTensioner(kind="sliding", pulley="dancer", direction=(0.0, 1.0), preload=120.0, rate=1e4)


def act(load: Trim, shaft: ShaftState, name: str) -> Any:
    """What a kernel of the load gives."""
    constants = blank(load.constants)
    fill(constants, load.values())
    return interpreted(getattr(type(load), name))(constants, np.zeros(0), shaft)


@pytest.mark.parametrize(("error", "trim"), [(0.01, 0.06), (-0.03, -0.02), (1.0, 0.1), (-1.0, -0.1)])
def test_a_trim_changes_speed_or_torque_up_to_its_limit(error: float, trim: float) -> None:
    shaft = SHAFT._replace(error=error)
    assert SPEED.trim_at(SHAFT.error, SHAFT.state) == pytest.approx(0.06)
    assert act(SPEED, shaft, "torque_at").torque == pytest.approx(3.0 * ((1.0 + trim) * 50.0 - 40.0))
    assert act(TORQUE, shaft, "torque_at").torque == pytest.approx((1.0 + trim) * 50.0)


@pytest.mark.parametrize("error", [0.01, -0.03, 1.0, -1.0])
@pytest.mark.parametrize("load", [SPEED, TORQUE], ids=["speed", "torque"])
def test_derivatives_are_those_of_torque_and_rate(load: Trim, error: float) -> None:
    shaft = SHAFT._replace(error=error)
    torque, rate, slope = (act(load, shaft, name) for name in ("torque_at", "rate_at", "slope_at"))

    def by(field: str, name: str) -> float:
        sides = (act(load, shaft._replace(**{field: getattr(shaft, field) + step}), name)[0] for step in (1e-6, -1e-6))
        return float(np.subtract(*sides)) / 2e-6

    expected = [by(field, "torque_at") for field in ("angle", "speed", "command", "state", "error")]
    found = torque.by_angle, torque.by_speed, torque.by_command, rate.torque_by_state, slope[0]
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)
    expected = [by(field, "rate_at") for field in ("speed", "state", "error")]
    assert (rate.by_speed, rate.by_state, slope[1]) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_a_controller_without_an_integral_part_has_no_state() -> None:
    plain = SPEED.replace(integral_time=None)
    assert plain.state_lag is None
    assert plain.trim_at(0.01, 5.0) == pytest.approx(0.02)


@pytest.mark.parametrize("position", [0.0, 2e-3])
@pytest.mark.parametrize("arm", [1.0, 0.25])
def test_what_is_measured_is_zero_where_the_sensor_stands_as_set(position: float, arm: float) -> None:
    """A dancer by the way of its pulley, a load cell by the force of its spring there."""
    rate, zero = SPEED.replace(set_position=arm * position).error_of(CELL, arm)
    assert (rate, zero + rate * position) == pytest.approx((arm, 0.0))
    force = (CELL.preload - CELL.rate * position) / arm
    load_cell = SPEED.replace(position_gain=None, set_force=force, force_gain=1e-3)
    rate, zero = load_cell.error_of(CELL, arm)
    assert zero + rate * position == pytest.approx(0.0, abs=1e-9)
    assert zero + rate * (position + 1e-3) == pytest.approx(
        force - (CELL.preload - CELL.rate * (position + 1e-3)) / arm
    )
    assert load_cell.trim_at(5.0, 0.0) == pytest.approx(5e-3)


def test_kinds_are_registered() -> None:
    assert (LOADS["speed_trim"], LOADS["torque_trim"]) == (SpeedTrim, TorqueTrim)

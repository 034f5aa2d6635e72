"""Every branch of every load: derivatives by central differences, power that a passive load takes, mirror images."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import blank, fill
from beltdyn.kernel import interpreted
from beltdyn.machines.loads.load import LOADS, LoadTorque, ShaftState
from tests.unit.machines.loads.test_driven_machines import BAND, BRAKE, FAN, GENERATOR, PUMP
from tests.unit.machines.loads.test_induction_motor import MOTOR, inverter
from tests.unit.machines.loads.test_motor import DC, SERVO
from tests.unit.machines.loads.test_table import CRANK, GRID

TABLE = {"kind": "table", "speeds": [0.0, 100.0, 200.0], "torques": [-1.0, -3.0, -4.0]}

CASES: dict[str, tuple[dict[str, Any], float, float, float]] = {
    # load, speed (rad/s), command, state of its controller
    "fan": (FAN, 90.0, 0.0, 0.0),
    "fan-back": (FAN, -0.05, 0.0, 0.0),
    "pump": (PUMP, 0.07, 180e5, 0.0),
    "brake": (BRAKE | {"backward_ratio": 0.5}, 0.06, 80.0, 0.0),
    "brake-back": (BRAKE | {"backward_ratio": 0.5}, -0.06, 80.0, 0.0),
    "band": (BAND, -0.03, 200.0, 0.0),
    "generator-regulated": (GENERATOR, 300.0, 1200.0, 0.0),
    "generator-full-field": (GENERATOR, 180.0, 1200.0, 0.0),
    "generator-full-field-back": (GENERATOR, -400.0, 2200.0, 0.0),
    "servo": (SERVO, 95.0, 100.0, 0.02),
    "servo-at-its-limit": (DC, 0.0, 100.0, 0.0),
    "servo-at-full-voltage": (DC, 90.0, 100.0, 0.0),
    "servo-at-full-voltage-back": (DC, -90.0, -100.0, 0.0),
    "motor-stable": (inverter(49.0), 150.0, 49.0, 0.0),
    "motor-pull-up": (MOTOR, 60.0, 49.0, 0.0),
    "motor-start": (MOTOR, 10.0, 49.0, 0.0),
    "motor-weak-field": (inverter(70.0), 205.0, 70.0, 0.0),
    "motor-weak-field-start": (inverter(70.0), 60.0, 70.0, 0.0),
    "table": (TABLE, 130.0, 0.0, 0.0),
    "table-beyond-its-end": (TABLE, 230.0, 0.0, 0.0),
    "table-before-its-start": (TABLE, -5.0, 0.0, 0.0),
    "angle-table": (CRANK, 130.0, 0.0, 0.0),
    "angle-speed-table": (GRID, 13.0, 0.0, 0.0),
    "angle-speed-table-beyond-its-end": (GRID, 130.0, 0.0, 0.0),
}


def torque(load: dict[str, Any], shaft: ShaftState) -> LoadTorque:
    kind = LOADS[load["kind"]]
    made = kind(**load)
    constants = blank(kind.constants)
    fill(constants, made.values())
    found: LoadTorque = interpreted(kind.torque_at)(constants, np.asarray(made.numbers, dtype=float), shaft)
    return found


@pytest.mark.parametrize("name", CASES)
def test_derivatives_are_those_of_the_torque(name: str) -> None:
    load, speed, command, state = CASES[name]
    shaft = ShaftState(0.0, 0.3, speed, command, state)
    found = torque(load, shaft)
    by_angle, by_speed, by_command = (
        (
            torque(load, shaft._replace(**{field: value + step})).torque
            - torque(load, shaft._replace(**{field: value - step})).torque
        )
        / (2.0 * step)
        for field, value, step in (
            ("angle", 0.3, 1e-6),
            ("speed", speed, 1e-6),
            ("command", command, 1e-6 * max(1.0, abs(command))),
        )
    )
    assert found.by_angle == pytest.approx(by_angle, rel=1e-5, abs=1e-7)
    assert found.by_speed == pytest.approx(by_speed, rel=1e-5, abs=1e-7)
    assert found.by_command == pytest.approx(by_command, rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("name", [name for name in CASES if not name.startswith(("servo", "motor", "table", "angle"))])
def test_a_driven_machine_takes_power(name: str) -> None:
    load, speed, command, state = CASES[name]
    assert torque(load, ShaftState(0.0, 0.3, speed, command, state)).torque * speed < 0.0


@pytest.mark.parametrize("name", [name for name in CASES if name.startswith(("servo", "generator", "pump", "fan"))])
def test_the_mirror_image_has_the_opposite_torque(name: str) -> None:
    """Set speeds turn around with the shaft; powers and pressures do not."""
    load, speed, command, state = CASES[name]
    turned = -command if name.startswith("servo") else command
    found = torque(load, ShaftState(0.0, 0.3, speed, command, state))
    other = torque(load, ShaftState(0.0, -0.3, -speed, turned, -state))
    assert other.torque == pytest.approx(-found.torque, rel=1e-12)
    assert other.by_speed == pytest.approx(found.by_speed, rel=1e-12)

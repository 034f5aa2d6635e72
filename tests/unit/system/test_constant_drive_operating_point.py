"""Where motors and loads balance without slip."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.system.build import drive_system
from beltdyn.system.constant_drive import constant_drive, operating_point

MOTOR = {"kind": "motor", "breakdown_torque": 60.0, "breakdown_slip": 0.2, "synchronous_speed": 150.0}


def found(drive: Drive, driver: dict[str, Any], driven: dict[str, Any]) -> tuple[float, int | None]:
    first, second = ({"name": p.name, "center": p.center, "radius": p.radius, "inertia": 0.1} for p in drive.pulleys)
    system = constant_drive(drive_system(prepare(drive.replace(pulley=[first | driver, second | driven]))), 1.0)
    return operating_point(system, drive.path.radii, system.bodies.unknown[system.pulleys.shaft] < 0)


def test_a_motor_and_its_load(drive: Drive) -> None:
    """On equal pulleys the load's torque at the speed that is found is Kloss's."""
    speed, driver = found(drive, {"load": [MOTOR]}, {"load": [{"kind": "resistance", "linear": 0.2}]})
    omega = speed / drive.radii[0]
    slip = 1.0 - omega / 150.0
    assert driver == 0
    assert 0.2 * omega == pytest.approx(2.0 * 60.0 / (slip / 0.2 + 0.2 / slip), rel=2e-3)


def test_the_sense_of_a_motor(drive: Drive) -> None:
    load = {"load": [{"kind": "resistance", "linear": 0.2}]}
    ahead, back = (found(drive, {"load": [MOTOR | {"synchronous_speed": speed}]}, load)[0] for speed in (150.0, -150.0))
    assert back == -ahead < 0.0


def test_a_prescribed_speed(drive: Drive) -> None:
    speed, driver = found(drive, {"speed": {"kind": "constant", "value": -30.0}, "inertia": 0.0}, {})
    assert (speed, driver) == (-30.0 * drive.radii[0], None)


def test_nothing_drives(drive: Drive) -> None:
    with pytest.raises(ModelError, match="no operating point"):
        found(drive, {}, {"load": [{"kind": "resistance", "linear": 0.2}]})
    with pytest.raises(ModelError, match="every prescribed speed is zero"):
        found(drive, {"speed": {"kind": "constant", "value": 0.0}, "inertia": 0.0}, {})

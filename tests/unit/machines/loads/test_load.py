"""Loads and motors: units, and what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.machines import Load
from beltdyn.model import LoadTable, Motor, PowerTable, Resistance

MOTOR = {"kind": "motor", "breakdown_torque": "12 N m", "breakdown_slip": 0.2, "synchronous_speed": "1500 rpm"}


@pytest.mark.parametrize(
    ("kind", "given", "sentence"),
    [
        (Resistance, {"kind": "resistance"}, "has no resistance. Give constant, linear or quadratic"),
        (Resistance, {"kind": "resistance", "linear": -1.0}, "must be at least 0"),
        (Resistance, {"kind": "resistance", "constant": 1.0, "creep_speed": 0.0}, "must be greater than 0"),
        (LoadTable, {"kind": "table", "speeds": [0.0, 1.0], "torques": [1.0]}, "needs at least 2 entries"),
        (
            LoadTable,
            {"kind": "table", "speeds": [0.0, 1.0, 2.0], "torques": [1.0, 2.0]},
            "speeds has 3 numbers but torques has 2. Give one torque for each speed",
        ),
        (
            LoadTable,
            {"kind": "table", "speeds": [1.0, 1.0], "torques": [1.0, 2.0]},
            "speeds must increase, but 1 follows 1. Sort the points by speed",
        ),
        (
            LoadTable,
            {"kind": "table", "file": "x.csv", "speeds": [0, 1]},
            "file and speeds and torques exclude each other",
        ),
        (LoadTable, {"kind": "table", "file": "nowhere.csv"}, "cannot be read"),
        (PowerTable, {"kind": "power", "speeds": [0.0], "powers": [1.0]}, "must be greater than 0"),
        (PowerTable, {"kind": "power", "speeds": [1.0], "powers": [-1.0]}, "must be at least 0"),
        (Motor, MOTOR | {"synchronous_speed": 0.0}, "synchronous_speed = 0 leaves the slip undefined"),
        (Motor, MOTOR | {"breakdown_slip": 1.2}, "must be at most 1"),
        (Motor, MOTOR | {"breakdown_torque": 0.0}, "must be greater than 0"),
        (Motor, MOTOR | {"schedule": {"kind": "constant", "value": 1.5}}, "must be at most 1"),
        (Motor, MOTOR | {"schedule": {"kind": "constant", "value": "1 s"}}, "must be a number without a unit"),
        (Motor, MOTOR | {"schedule": {"kind": "cosine_ramp_published"}}, "is not a valid choice"),
    ],
)
def test_errors(kind: type[Load], given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        kind(**given)
    assert sentence in str(caught.value)


def test_units() -> None:
    motor = Motor(**MOTOR)
    assert motor.synchronous_speed == pytest.approx(157.0796, rel=1e-6)
    fan = Resistance(kind="resistance", quadratic="2e-3 N m s^2/rad^2", linear="1e-3 N m s", creep_speed="1 rpm")
    assert (fan.quadratic, fan.linear) == (2e-3, 1e-3)


def test_a_table_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "pump.csv"
    file.write_text("speed,torque\n0,0\n100, -3.5\n")
    table = LoadTable.model_validate({"kind": "table", "file": file})
    assert (table.speeds, table.torques) == ((0.0, 100.0), (0.0, -3.5))


def test_power_over_speed_opposes_the_motion_in_either_sense(tmp_path: Path) -> None:
    """2 kW at 1000 rpm and 3 kW at 3000 rpm: 19.10 and 9.55 N m, on straight lines, constant beyond."""
    load = PowerTable(kind="power", speeds=["1000 rpm", "3000 rpm"], powers=["2 kW", "3 kW"])
    rpm = np.pi / 30.0
    torques = [2000.0 / (1000.0 * rpm), 3000.0 / (3000.0 * rpm)]
    for speed, expected in (
        (500.0, torques[0] / 2),
        (1000.0, torques[0]),
        (2000.0, np.mean(torques)),
        (9e3, torques[1]),
    ):
        for sense in (1.0, -1.0):
            found = load.torque_over(np.zeros(1), sense * speed * rpm)[0]
            assert found == pytest.approx(-sense * expected)
    file = tmp_path / "pump.csv"
    file.write_text("speed [rpm],power [kW]\n1000,2\n3000,3\n")
    assert PowerTable.model_validate({"kind": "power", "file": file}).powers == load.powers


def test_a_motor_drives_up_to_its_synchronous_speed_and_a_resistance_drives_nothing() -> None:
    assert Motor(**MOTOR | {"synchronous_speed": -40.0}).driven_speed == -40.0
    assert Resistance(kind="resistance", linear=0.1).driven_speed == 0.0


def test_the_least_table_is_a_line() -> None:
    table = LoadTable(kind="table", speeds=(0.0, 10.0), torques=(1.0, -1.0))
    assert table.numbers == (0.0, 10.0, 1.0, -1.0)


@pytest.mark.parametrize(
    ("speeds", "torques", "driven"),
    [
        ((0.0, 400.0, 1560.0, 1600.0), (1.6, 1.6, 0.45, 0.0), 1600.0),  # a universal motor
        ((0.0, 100.0), (2.0, -2.0), 50.0),
        ((-100.0, 0.0), (2.0, -2.0), -50.0),
        ((-100.0, 100.0), (5.0, 5.0), 100.0),
        ((0.0, 10.0, 100.0), (-1.0, 1.0, 1.0), 100.0),
        ((0.0, 100.0), (0.0, -5.0), 0.0),  # a fan
        ((-1.0, 1.0), (3.0, -3.0), 0.0),  # dry friction
    ],
)
def test_a_table_whose_torques_drive_is_a_motor(
    speeds: tuple[float, ...], torques: tuple[float, ...], driven: float
) -> None:
    """Up to the speed at which the torque turns against it; turned around it drives the other way."""
    table = LoadTable(kind="table", speeds=speeds, torques=torques)
    assert table.driven_speed == pytest.approx(driven)
    if not all(torque == torques[0] for torque in torques):
        assert table.reversed().driven_speed == pytest.approx(-driven)

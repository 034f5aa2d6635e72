"""Drives at other operating points."""

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.points.changed_drive import (
    at_instant,
    at_speed,
    driver_of,
    held_at,
    sense_of,
    under_power,
    under_torque,
    with_load,
)


@pytest.fixture
def loaded(drive: Drive) -> Drive:
    """A driven pulley with a fan, a motor and a torque."""
    driver, driven = drive.pulleys
    fan = {
        "kind": "fan",
        "rated_power": 4.0,
        "rated_speed": 12.0,
        "schedule": {"kind": "constant", "value": 0.5},
    }
    motor = {"kind": "motor", "breakdown_torque": 1.0, "breakdown_slip": 0.2, "synchronous_speed": 20.0}
    torque = {"kind": "constant", "value": -2.0}
    return drive.replace(pulley=[driver, driven.replace(torque=torque, load=[fan, motor])])


def total(drive: Drive, kind: str, name: str) -> float:
    """Sum of a number of loads of a kind, times their schedules."""
    loads = [load for load in drive.pulleys[1].load if load.kind == kind]
    return float(
        sum(getattr(load, name) * (1.0 if load.schedule is None else load.schedule.at([0.0])[0]) for load in loads)
    )


@pytest.mark.parametrize("factor", [0.0, 0.4, 1.0, 2.0, 2.7])
def test_loads_are_multiplied_and_motors_are_not(loaded: Drive, factor: float) -> None:
    found = with_load(loaded, factor)
    assert total(found, "fan", "rated_power") == pytest.approx(2.0 * factor)
    assert total(found, "motor", "breakdown_torque") == 1.0
    assert found.pulleys[1].torque is not None
    assert found.pulleys[1].torque.at([0.0])[0] == pytest.approx(-2.0 * factor)


def test_a_speed_stands_in_place_of_motor_and_loads(loaded: Drive) -> None:
    found = at_speed(loaded, 1, -3.0).pulleys[1]
    assert found.speed is not None
    assert (found.speed.at([0.0])[0], found.torque, found.load) == (-3.0, None, ())


def test_a_torque_leaves_motors(loaded: Drive) -> None:
    found = under_torque(loaded.pulleys[1], -7.0)
    assert found.torque is not None
    assert found.torque.at([0.0])[0] == -7.0
    assert [load.kind for load in found.load] == ["motor"]
    with pytest.raises(ModelError, match="driver has a prescribed speed"):
        under_torque(loaded.pulleys[0], 1.0)


def test_a_power_is_taken_at_the_speed_without_slip(loaded: Drive) -> None:
    driver, driven = at_speed(loaded, 0, 20.0).pulleys
    found = under_power(loaded, 1, 100.0, [driver, driven])
    assert found.torque is not None
    speed = 20.0 * loaded.path.radii[0] / loaded.path.radii[1]
    assert found.torque.at([0.0])[0] == pytest.approx(-100.0 / speed)


def test_what_drives(loaded: Drive) -> None:
    assert driver_of(loaded) == 0
    free = loaded.pulleys[0].replace(speed=None, inertia=1.0)
    assert driver_of(loaded.replace(pulley=[free, loaded.pulleys[1]])) == 1
    with pytest.raises(ModelError, match="nothing drives"):
        driver_of(loaded.replace(pulley=[free, loaded.pulleys[1].replace(load=[])]))
    with pytest.raises(ModelError, match=r"pulley = 'fan' is not in this drive\. Choose one of driver, driven"):
        loaded.number_of("fan")


def test_its_sense_and_an_instant(drive: Drive) -> None:
    assert sense_of(drive, 0) == sense_of(drive, 1) == 1.0
    assert sense_of(at_speed(drive, 0, -5.0), 0) == -1.0
    speeds = [held_at(drive, at).pulleys[0].speed.at([0.0])[0] for at in (0.0, None)]  # type: ignore[union-attr]
    assert speeds == [0.0, 12.0]
    assert bd.loads(held_at(drive, None).text) == held_at(drive, None)


def test_a_web_line_keeps_its_draws_at_another_speed(drive: Drive) -> None:
    centers = {"a": [0.4, 0.0], "b": [0.8, -0.1], "c": [1.2, 0.0]}
    first, second, idler = ({"name": name, "center": center, "radius": 0.05} for name, center in centers.items())
    line = Drive(
        belt={"axial_stiffness": 2e4, "bending_stiffness": 1e-4, "mass_per_length": 0.05, "thickness": 1e-4}
        | {"width": 0.2},
        unwinder={"point": [0.0, 0.3], "tension": 100.0},
        pulley=[first | {"speed": 40.0}, second | {"speed": 40.04}, idler | {"inertia": 1e-3}],
        winder={"point": [1.5, 0.3], "tension": 100.0},
        contact={"friction": 0.4},
        simulation={"duration": 1.0},
    )
    for number, speed, expected in ((1, 20.02, [20.0, 20.02]), (2, 20.0, [40.0, 40.04, 20.0])):
        turned = [one.driven_speed() for one in at_speed(line, number, speed).pulleys if one.speed is not None]
        assert turned == pytest.approx(expected, rel=1e-12)
    assert at_speed(drive, 0, 20.0).pulleys[1] == drive.pulleys[1]


def test_goods_are_loads_and_are_held_at_an_instant() -> None:
    late = {"kind": "step", "time": 2.0, "value": 1.0}
    drive = bd.example("package_conveyor")
    drive = drive.replace(goods=[drive.goods[0].replace(schedule=late)])
    assert [at_instant(drive, at).goods[0].schedule.at([9.0])[0] for at in (1.0, 3.0)] == [0.0, 1.0]  # type: ignore[union-attr]
    assert with_load(drive, 0.5).goods[0].mass_per_length == 0.5 * drive.goods[0].mass_per_length
    assert with_load(drive, 0.0).goods == ()

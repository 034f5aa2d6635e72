"""A load by a user's function: its torque and derivatives, files, and what is refused."""

import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.designs.batch import simulate_all
from beltdyn.errors import ModelError
from beltdyn.machines.loads.load import LoadTorque
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.model import Drive, FunctionLoad, dumps, loads
from beltdyn.system.build_machines import machine_arrays

Torque = Callable[..., LoadTorque]


def brake(time: float, angle: float, speed: float) -> float:
    return -time * (2.0 + math.sin(3.0 * angle)) * speed * speed


def by_angle(time: float, angle: float, speed: float) -> float:
    return -time * 3.0 * math.cos(3.0 * angle) * speed * speed


def by_speed(time: float, angle: float, speed: float) -> float:
    return -time * (2.0 + math.sin(3.0 * angle)) * 2.0 * speed


@pytest.fixture
def carrying(drive: Drive) -> Drive:
    """A drive with such a load."""
    driver, driven = drive.pulleys
    return drive.replace(pulley=[driver, driven.replace(torque=None, load=[FunctionLoad(function=brake)])])


def test_torque_and_differences(torque: Torque) -> None:
    found = torque({"kind": "function", "function": brake}, 40.0, angle=0.3, time=1.5)
    exact = [one(1.5, 0.3, 40.0) for one in (brake, by_angle, by_speed)]
    assert found[0] == pytest.approx(exact[0], rel=1e-14)
    assert found[1:3] == pytest.approx(exact[1:], rel=1e-8)


def test_derivatives_may_be_given(torque: Torque) -> None:
    load = {"kind": "function", "function": brake, "derivatives": (by_angle, by_speed)}
    exact = [one(1.5, 0.3, 40.0) for one in (brake, by_angle, by_speed)]
    assert torque(load, 40.0, angle=0.3, time=1.5)[:3] == pytest.approx(exact, rel=1e-14)


def test_the_order_and_the_speed_that_are_given() -> None:
    load = FunctionLoad(function=brake, highest_order=12, drives_to=30.0, harmonics=[{"order": 2, "amplitude": 0.1}])
    assert (list(load.orders), load.driven_speed) == ([2.0, 12.0], 30.0)
    assert list(FunctionLoad(function=brake).orders) == []


def test_no_drive_file_holds_a_function(carrying: Drive) -> None:
    name = carrying.pulleys[1].name
    with pytest.raises(ModelError, match=f'pulley "{name}" has a load of kind "function": a drive file cannot hold'):
        dumps(carrying)


def test_no_other_process_gets_a_function(carrying: Drive, tmp_path: Path) -> None:
    """It is refused before anything starts, and is not lost on the way."""
    told = list[object]()
    with pytest.raises(ModelError, match=r'load of kind "function": run.nc runs in another process.* Call `simulate`'):
        simulate_all({tmp_path / "run.nc": carrying}, told.append)
    assert told == []
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ModelError, match="other processes get a drive as text"):
        pickle.dumps(carrying)


def test_a_result_keeps_the_name_of_the_function(carrying: Drive) -> None:
    read = loads(carrying.text)
    assert read.pulleys[1].load[0].arguments["function"] == "brake"
    with pytest.raises(
        ModelError, match='the function "brake" of a load is not in the file, which holds only its name'
    ):
        machine_arrays(read.pulleys)


def test_a_drive_keeps_its_function(carrying: Drive) -> None:
    changed = carrying.replace(simulation=carrying.simulation.replace(duration=0.1))
    machines = machine_arrays(changed.pulleys)
    found = shaft_torque(machines.profiles, machines.shaft_loads, 1, 1.5, 0.3, 40.0, np.zeros(0)).torque
    assert found == pytest.approx(brake(1.5, 0.3, 40.0), rel=1e-14)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"function": 3.0}, "must be a function of time, angle and speed, not 3.0"),
        ({"function": brake, "derivatives": by_angle}, "must be two functions"),
        ({}, "function"),
    ],
)
def test_errors(given: dict[str, Any], sentence: str, tmp_path: Path) -> None:
    with pytest.raises(ModelError) as caught:
        FunctionLoad(**given)
    assert sentence in str(caught.value)

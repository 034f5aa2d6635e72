"""Torque of one load on a shaft, for the tests of its kinds."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.machines.loads.load import LoadTorque
from beltdyn.machines.loads.shaft import load_bend, shaft_torque
from beltdyn.model import Pulley
from beltdyn.system.build_machines import Machines, machine_arrays

Torque = Callable[..., LoadTorque]
Kinks = Callable[..., list[float]]


def _machines(load: dict[str, Any]) -> Machines:
    return machine_arrays([Pulley(name="one", center=(0, 0), radius=1, inertia=1, load=[load])])


@pytest.fixture
def torque() -> Torque:
    """Torque of a load, given as its keys, at a speed, an angle and a time."""

    def find(
        load: dict[str, Any], speed: float, angle: float = 0.0, time: float = 0.0, state: float = 0.0
    ) -> LoadTorque:
        machines, states = _machines(load), np.array([0.0, state])
        return shaft_torque(machines.profiles, machines.shaft_loads, 0, time, angle, speed, states)

    return find


@pytest.fixture
def kinks() -> Kinks:
    """Speeds of the kinks that a load says lie between two speeds, in the order in which they are passed."""

    def find(load: dict[str, Any], start: float, end: float) -> list[float]:
        machines, found, rate = _machines(load), list[float](), float(np.sign(end - start))
        while True:
            since = load_bend(machines.profiles, machines.shaft_loads, 0, 0.0, start, rate)[0]
            start += rate * since
            if not rate * start < rate * end:
                return found
            found.append(start)
            start = float(np.nextafter(start, end))

    return find

"""Quick drives to simulate, and an open belt beside a pulley whose motion is known in closed form."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from beltdyn.model import Belt, Constant, Drive, Pulley
from beltdyn.model.instants import Instants
from beltdyn.solve.integrators.trajectory import Statistics, Task
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight

Change = Callable[..., Drive]


@pytest.fixture(scope="session")
def change(drive: Drive) -> Change:
    """The paper's drive with ten elements for 5 ms, with changed keys in its groups; a list replaces the pulleys."""

    def changed(pulley: list[Any] | None = None, **groups: Mapping[str, Any]) -> Drive:
        data = drive.model_dump(by_alias=True, exclude_none=True)
        data["belt"]["elements"] = 10
        data["simulation"] |= {"duration": 5e-3, "output_interval": 1e-3, "start": "equilibrium"}
        for name, group in groups.items():
            data[name] |= group
        return Drive(**data | ({"pulley": pulley} if pulley else {}))

    return changed


@pytest.fixture(scope="session")
def failing(drive: Drive, change: Change) -> Drive:
    """A load beyond all reason sets in after 2.1 ms."""
    pulleys: list[dict[str, Any]] = [pulley.model_dump(exclude_none=True) for pulley in drive.pulleys]
    pulleys[1]["torque"] = {"kind": "table", "times": [0.0, 0.0021, 0.0022], "values": [0.0, 0.0, 1e15]}
    pulleys[1]["inertia"] = 1e-9
    return change(pulley=pulleys)


@pytest.fixture(scope="session")
def spinning(drive: Drive) -> System:
    """A belt at rest, and far from it a pulley that accelerates by 5 rad/s^2."""
    belt = Belt(**drive.belt.model_dump() | {"elements": 3})
    pulley = Pulley(name="far", center=(0.0, 50.0), radius=0.1, inertia=0.4, torque=Constant(value=2.0))
    return belt_system(belt, [pulley], drive.contact)


@pytest.fixture
def spin(spinning: System) -> Callable[..., Task]:
    """The task of following it for half a second."""

    def task(interval: float, breakpoints: tuple[float, ...] = (), system: System = spinning) -> Task:
        return Task(system, straight(system), Instants(interval, 0.5), breakpoints, 0.1, Statistics())

    return task

"""The drive of the paper, which the unit tests bend into every shape."""

import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

from beltdyn.kernel import interpreted
from beltdyn.model import Belt, Constant, Drive, Pulley, loads
from beltdyn.model.simulation import Instants
from beltdyn.signals import ENDING
from beltdyn.solvers.trajectory import Statistics, Task
from beltdyn.stretch import LAWS, StretchLaw, StretchParameters
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight

Change = Callable[..., Drive]

settings.register_profile("patient", deadline=None)  # loading units and kernels takes its time once
settings.load_profile("patient")


POINTS = {"contact", "elements", "machines", "stretch"}
"""Folders of kernels of a point, an element or a machine: Python runs their tests sooner than it compiles each of them.

In whole systems they are compiled. Alone they are with ``--compiled``, as `make compatibility` does.
"""


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> None:
    if not POINTS.isdisjoint(pyfuncitem.path.parts) and not pyfuncitem.config.getoption("--compiled"):
        pyfuncitem.obj = interpreted(pyfuncitem.obj)


@pytest.fixture(scope="session", params=list(LAWS.values()), ids=list(LAWS))
def stretch_law(request: pytest.FixtureRequest) -> StretchParameters:
    """Each law of stretch, with about 20 kN; a measured one softens like that of an elastic belt."""
    law: StretchLaw = request.param
    strains = np.array([0.0, 0.004, 0.01, 0.02, 0.05, 0.1, 0.3])
    if law.through is not None:
        measured: StretchParameters = law.through(strains, 600.0 * (np.sqrt(strains / 0.03 + 0.25) - 0.5))
        return measured
    made: StretchParameters = law.record(2e4, *(parameter.example for parameter in law.parameters))
    return made


@pytest.fixture(scope="session")
def drive_text() -> str:
    return files("beltdyn").joinpath("examples", "two_pulley.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def drive(drive_text: str) -> Drive:
    return loads(drive_text)


@pytest.fixture
def drive_file(tmp_path: Path, drive_text: str) -> Path:
    file = tmp_path / "drive.toml"
    file.write_text(drive_text, encoding="utf-8")
    return file


@pytest.fixture
def signal_defaults() -> Iterator[None]:
    """The signals that a program gets in the foreground: a shell starts one in the background with some ignored."""
    before = {number: signal.getsignal(number) for number in ENDING}
    for number in ENDING:
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def largest_file() -> Callable[[int], AbstractContextManager[None]]:
    """Let no file grow beyond a size in bytes, as a quota would or a full disk does."""
    return _largest_file


@contextmanager
def _largest_file(size: int) -> Iterator[None]:
    resource = pytest.importorskip("resource", reason="limits of files are a matter of POSIX")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


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


FATIGUE_DRIVE = """
[belt]
axial_stiffness = 5e4
bending_stiffness = 5e-4
mass_per_length = 0.1
width = 0.012
thickness = 0.008
installed_tension = 300
[belt.cord_fatigue]
cycles = [1e7, 1e9]
forces = [900.0, 600.0]
bending_force = 12.0
survival = 0.9
source = "test"
[belt.rib_fatigue]
diameter = 0.1
tension = 100
temperature = 80
passages = 1e9
source = "test"
[[pulley]]
name = "small"
center = [0, 0]
diameter = "90 mm"
speed = "1500 rpm"
[[pulley]]
name = "large"
center = ["500 mm", 0]
diameter = "180 mm"
inertia = 0.01
torque = -12
[contact]
friction = 1.0
[simulation]
duration = 0.1
"""


@pytest.fixture(scope="session")
def fatigue_drive() -> Drive:
    """A drive of two pulleys under constant load, with fatigue data that are easily reckoned with."""
    return loads(FATIGUE_DRIVE)

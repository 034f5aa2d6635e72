"""From a drive to an initial value problem: output instants, stops, and the velocity that errors are measured by."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Contact, Drive, prepare
from beltdyn.model.simulation import Instants
from beltdyn.solvers.trajectory import Chunk, Statistics, Task, drive_task, velocity_scale
from beltdyn.system.arrays import ENERGY_WORKS
from beltdyn.system.body_forces import body_forces_history
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

Change = Callable[..., Drive]


def task_of(drive: Drive) -> Task:
    system = drive_system(prepare(drive))
    return drive_task(prepare(drive), system, laid(system, drive.path), Statistics())


@pytest.mark.parametrize(
    ("duration", "interval", "count"),
    [(1.0, 1e-3, 1001), (0.3, 0.1, 4), (1.0, 0.3, 5), (0.1, 0.1, 2), (0.7, 1e-4, 7001), (1.0, 1 / 3, 4)],
)
def test_outputs_are_multiples_of_the_interval_and_the_end(
    change: Change, duration: float, interval: float, count: int
) -> None:
    instants = task_of(change(simulation={"duration": duration, "output_interval": interval})).instants
    times = instants[np.arange(instants.count)]
    assert len(times) == count
    assert [instants.until(time) for time in times] == list(range(1, count + 1))
    assert times[0] == 0.0
    assert times[-1] == duration
    np.testing.assert_array_equal(times[:-1], interval * np.arange(count - 1))
    assert np.all(np.diff(times) > 1e-9 * interval)


@pytest.mark.parametrize(
    ("duration", "stops"), [(1.0, [0.05, 0.6, 1.0]), (0.6, [0.05, 0.6]), (0.3, [0.05, 0.3]), (0.01, [0.01])]
)
def test_stops_are_the_kinks_of_both_profiles_once_and_the_end(
    change: Change, duration: float, stops: list[float]
) -> None:
    assert task_of(change(simulation={"duration": duration})).stops == stops


def test_velocity_scale(drive: Drive, change: Change) -> None:
    """The rim runs at 0.975 m/s at the end; a belt end that is let go runs at strain times wave speed."""
    strain = drive.path.length / drive.belt_length - 1.0
    recoil = strain * np.sqrt(1e8 / 1036.0)
    assert velocity_scale(prepare(drive)) == pytest.approx(max(12.0 * 0.08125, recoil))
    fast: list[dict[str, Any]] = [pulley.model_dump(exclude_none=True) for pulley in drive.pulleys]
    fast[0]["speed"] = {"kind": "constant", "value": -120.0}
    assert velocity_scale(prepare(change(pulley=fast))) == pytest.approx(120.0 * 0.08125)
    assert velocity_scale(prepare(change(simulation={"duration": 0.01, "output_interval": 0.01}))) == pytest.approx(
        recoil
    )


def test_a_motor_drives_up_to_its_synchronous_speed(drive: Drive, change: Change) -> None:
    motor = {"kind": "motor", "breakdown_torque": 5.0, "breakdown_slip": 0.2, "synchronous_speed": -100.0}
    pulleys: list[dict[str, Any]] = [pulley.model_dump(exclude_none=True) for pulley in drive.pulleys]
    pulleys[0] |= {"speed": None, "inertia": 0.1, "load": [motor]}
    assert velocity_scale(prepare(change(pulley=pulleys))) == pytest.approx(100.0 * 0.08125)


@pytest.mark.parametrize("interval", [0.05, 0.011, 0.5])
def test_outputs_need_only_the_states_around_them(change: Change, interval: float) -> None:
    """Steps of all lengths, some of which end on outputs; the states in between change nothing."""
    system, instants = drive_system(prepare(change())), Instants(interval, 3.0)
    random = np.random.default_rng(1)
    times = np.unique(np.append(random.uniform(0.0, 3.0, 120), instants[np.arange(0, instants.count, 2)]))
    count = len(times)
    position, velocity = random.uniform(size=(2, count, 3))
    work, forces = np.zeros((count, len(ENERGY_WORKS))), body_forces_history(system, count)
    chunk = Chunk(times, np.diff(times, prepend=0.0), position, velocity, work, forces, reached=3.0)
    around = chunk.around(instants, -interval)
    wanted = instants[np.arange(instants.count)]
    for found, expected in zip(chunk.only(around).at(wanted), chunk.at(wanted), strict=True):
        np.testing.assert_array_equal(found, expected)
    assert np.count_nonzero(around) < 2 * instants.count


def test_only_keys_of_contact_that_are_given_are_advised_against(drive: Drive) -> None:
    """A message that tells to omit keys names those of the drive file."""
    prepared = prepare(drive)
    open_keys = prepare(drive.replace(contact=Contact(friction=0.3)))
    given = [drive_task(one, None, None, Statistics()).contact_keys for one in (prepared, open_keys)]  # type: ignore[arg-type]
    assert "stiffness" in given[0]
    assert given[1] == ()

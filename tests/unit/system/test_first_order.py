"""The first-order form: rates against `accelerate`, its Jacobian against central differences."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, Pulley, prepare
from beltdyn.solvers.engine import accelerate
from beltdyn.system.arrays import POWERS, Motion, System
from beltdyn.system.build import drive_system
from beltdyn.system.first_order import FirstOrder
from beltdyn.system.state import State, laid
from beltdyn.system.steady_assembly import new_equations, no_multipliers

TIME = 0.3


@pytest.fixture(scope="module")
def equations(system: System) -> FirstOrder:
    return FirstOrder(system)


def test_pack_and_unpack(equations: FirstOrder, moving: State) -> None:
    position, velocity, work = equations.unpack(np.stack([equations.pack(moving)] * 3))
    np.testing.assert_array_equal(position, [moving.position] * 3)
    np.testing.assert_array_equal(velocity, [moving.velocity] * 3)
    np.testing.assert_array_equal(work, np.zeros((3, len(POWERS))))


def test_rates_are_the_accelerations_of_the_system(system: System, equations: FirstOrder, moving: State) -> None:
    """Inverse mass matrix (Eq. 27) or brackets of Eq. 26 against the solution of Eq. 25 by the ring solver."""
    work = new_equations(system)
    velocity, acceleration = moving.velocity.copy(), np.empty_like(moving.velocity)
    accelerate(system, Motion(TIME, moving.position, velocity, acceleration), no_multipliers(system), work)
    rates = equations.unpack(equations.rates(TIME, equations.pack(moving)))
    np.testing.assert_array_equal(rates[0], velocity)
    np.testing.assert_allclose(rates[1], acceleration, atol=1e-9 * np.max(np.abs(acceleration)))  # rounding
    np.testing.assert_allclose(rates[2], work.forces.power, rtol=1e-9)


def test_jacobian(system: System, equations: FirstOrder, moving: State, scale: FloatArray) -> None:
    y, size = equations.pack(moving), 2 * moving.position.size
    jacobian = equations.jacobian(TIME, y)
    steps = np.concatenate([1e-8 * scale, 1e-5 * scale])
    columns = []
    for k in range(size):
        change = np.zeros_like(y)
        change[k] = steps[k]
        columns.append((equations.rates(TIME, y + change) - equations.rates(TIME, y - change))[:size] / (2 * steps[k]))
    by_metre, found = steps / np.repeat([1e-8, 1e-5], size // 2), np.transpose(columns)
    for part in (slice(0, size // 2), slice(size // 2, size)):
        expected, given = found[:, part] * by_metre[part], jacobian[:size, part] * by_metre[part]
        np.testing.assert_allclose(given, expected, atol=1e-6 * np.max(np.abs(expected)))  # rounding of differences


def test_tolerances_are_lengths(system: System, equations: FirstOrder) -> None:
    tolerances = equations.tolerances(1e-3, 0.1)
    position, velocity, work = equations.unpack(tolerances)
    np.testing.assert_allclose(velocity[: len(system.scale)] * system.scale, 1e-3)
    np.testing.assert_allclose(velocity[-2:] * system.pulleys.radius, 1e-3)
    np.testing.assert_allclose(position, 0.1 * velocity)
    assert np.all(work > 1e5)


def test_a_jump_brings_drivers_to_their_speed(system: System, moving: State) -> None:
    """The driver gives the kinetic energy that its body gains; all else keeps its motion."""
    driver, bodies = system.first_body, system.bodies.copy()
    bodies.inertia[0] = 0.2
    equations = FirstOrder(system._replace(bodies=bodies))
    y = equations.pack(moving)
    before = equations.unpack(y.copy())
    equations.jump(TIME, y)
    position, velocity, work = equations.unpack(y)
    expected = equations.rates(TIME, y)[driver]
    assert velocity[driver] == expected != before[1][driver]
    gain = 0.5 * 0.2 * (velocity[driver] ** 2 - before[1][driver] ** 2)
    np.testing.assert_allclose(work, np.where(np.array(POWERS) == "driver_work", gain, 0.0), rtol=1e-12)
    for now, then in ((position, before[0]), (velocity, before[1])):
        np.testing.assert_array_equal(np.delete(now, driver), np.delete(then, driver))


def test_counts_its_evaluations(system: System, moving: State) -> None:
    equations = FirstOrder(system)
    for _ in range(3):
        equations.rates(TIME, equations.pack(moving))
    assert equations.evaluations == 3


def assert_columns(system: System, equations: FirstOrder, y: FloatArray, unknowns: list[int]) -> None:
    """Columns of the Jacobian against differences, each row of a body at its own size."""
    half, jacobian = system.first_body + system.bodies.size, equations.jacobian(TIME, y)
    for unknown in unknowns:
        change, step = np.zeros_like(y), 1e-8 if unknown < half else 1e-5
        change[unknown] = step
        found = (equations.rates(TIME, y + change) - equations.rates(TIME, y - change))[: 2 * half] / (2.0 * step)
        bodies = range(half + system.first_body, 2 * half)
        for part in (slice(0, half), slice(half, bodies.start), *(slice(k, k + 1) for k in bodies)):
            size = max(np.abs(found[part]).max(), 1e-9 * np.abs(found).max())
            np.testing.assert_allclose(jacobian[: 2 * half, unknown][part], found[part], atol=1e-6 * size)


@pytest.mark.parametrize("tensioner", ["rotary", "sliding"])
def test_jacobian_of_bodies(with_machines: Callable[[str], Drive], tensioner: str) -> None:
    """Tensioner, hub chain and loads, each row at its own size beside the far larger ones of the belt."""
    system = drive_system(prepare(with_machines(tensioner)))
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 3e-4), np.array([2e-3])).position
    velocity = 0.5 * np.random.default_rng(1).normal(size=rest.size)
    equations = FirstOrder(system)
    y = equations.pack(State(rest, velocity, velocity))
    bodies = range(system.first_body, rest.size)
    assert_columns(system, equations, y, [*bodies, *(rest.size + body for body in bodies)])


def test_jacobian_where_a_tensioner_is_the_only_free_body(with_machines: Callable[[str], Drive]) -> None:
    """All shafts run at given speeds; the arm turns, so that the center it carries speeds up as it moves."""
    drive = with_machines("rotary")
    steady = {"speed": {"kind": "constant", "value": 5.0}, "inertia": 0.1, "mass": 0.3}
    kept = ("name", "center", "radius")
    pulleys = [Pulley(**steady | {key: getattr(pulley, key) for key in kept}) for pulley in drive.pulleys]
    system = drive_system(prepare(drive.replace(pulley=pulleys)))
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 3e-4), np.array([2e-3])).position
    velocity = 0.5 * np.random.default_rng(1).normal(size=rest.size)
    equations = FirstOrder(system)
    assert system.bodies.unknown.tolist() == [-1, -1, -1, 0]
    y = equations.pack(State(rest, velocity, velocity))
    assert_columns(system, equations, y, [rest.size - 1, 2 * rest.size - 1])


def test_jacobian_of_a_driver_behind_an_isolator(make_drive: Callable[..., Drive]) -> None:
    """The driver turns the end of its hub chain; the rim before it is free, and the first unknown."""
    drive = make_drive("force_slope", "fixed")
    driver, driven = drive.pulleys
    isolator = {"kind": "isolator", "stiffness": 50.0, "damping": 0.3, "inertia": 0.1}
    system = drive_system(prepare(drive.replace(pulley=[driver.replace(hub=[isolator], inertia=0.02), driven])))
    assert system.bodies.unknown.tolist() == [0, 1, -1]
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 3e-4)).position
    rest[system.first_body :] = [0.2, 0.1, 0.5]
    velocity = 0.5 * np.random.default_rng(1).normal(size=rest.size)
    equations = FirstOrder(system)
    y = equations.pack(State(rest, velocity, velocity))
    bodies = [start + body for start in (system.first_body, rest.size + system.first_body) for body in range(3)]
    assert_columns(system, equations, y, bodies)
    rates = equations.unpack(equations.rates(TIME, y))
    shaft = system.first_body + 2
    assert rates[0][shaft] == pytest.approx(float(driver.speed.at(TIME)))  # type: ignore[union-attr]
    assert rates[1][shaft] == pytest.approx(12.0 / 0.55)
    np.testing.assert_array_equal(np.delete(rates[0], shaft), np.delete(velocity, shaft))


def test_a_drive_without_free_bodies(make_drive: Callable[..., Drive]) -> None:
    """Both shafts run at given speeds: nothing but the belt has accelerations of its own."""
    drive = make_drive("force_slope", "zone")
    driver, driven = drive.pulleys
    steady = Pulley(name="steady", center=driven.center, radius=driven.radius, speed={"kind": "constant", "value": 2.0})
    system = drive_system(prepare(drive.replace(pulley=[driver, steady])))
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 3e-4)).position
    equations = FirstOrder(system)
    y = equations.pack(State(rest, 0.0 * rest, 0.0 * rest))
    assert_columns(system, equations, y, [0, 7, rest.size + 3])

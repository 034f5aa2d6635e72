"""Momentum, moment of momentum and energy of a whole drive at one instant: what forces and powers say changes them."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, prepare
from beltdyn.system.arrays import POWERS, System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import drive_system
from beltdyn.system.first_order import FirstOrder, mass_matrix
from beltdyn.system.observations import OBSERVED, Observations
from beltdyn.system.observe import observe, observe_motion
from beltdyn.system.state import State, laid

TIME = 0.3
GIVEN, LOST = POWERS[:2], POWERS[2:]
STORED = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")


@pytest.fixture
def joined(system: System, moving: State) -> State:
    """The state, with the ends of a belt joined by multipliers at one place: these give no moment and no power."""
    position, velocity, dof = moving.position.copy(), moving.velocity.copy(), len(system.scale)
    if system.joint:
        last = slice(system.first_body - dof, system.first_body)
        position[last], velocity[last] = position[:dof], velocity[:dof]
    return State(position, velocity, moving.acceleration)


def at_points(system: System) -> System:
    """The same with contact at points that stay where they are in the belt: its energy is then a sum over them."""
    return system._replace(law=system.law._replace(follow_zone=False))


def see(system: System, time: float, position: FloatArray, velocity: FloatArray) -> Observations:
    return observe(system, np.array([time]), position[None].copy(), velocity[None].copy())


def rates(system: System, state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Velocities, accelerations and powers."""
    equations = FirstOrder(system)
    return equations.unpack(equations.rates(TIME, equations.pack(state)))


def assert_energy_closes(system: System, state: State) -> None:
    """The rate of the stored energy along the motion is what drivers and torques give less what is lost."""
    velocity, acceleration, powers = rates(system, state)

    def energy(after: float) -> float:
        seen = see(system, TIME + after, state.position + after * velocity, velocity + after * acceleration)
        return float(sum(getattr(seen, name)[0] for name in STORED))

    step = 1e-8
    rate = (energy(step) - energy(-step)) / (2.0 * step)
    given = float(powers[: len(GIVEN)].sum())
    lost = powers[len(GIVEN) :]
    assert np.all(lost >= 0.0)
    assert lost[LOST.index("friction_loss")] > 0.0
    size = np.abs(powers).sum() + abs(rate)
    assert rate == pytest.approx(given - float(lost.sum()), abs=1e-6 * size)  # rounding of joules over the step


def test_energy(system: System, joined: State) -> None:
    assert_energy_closes(at_points(system), joined)


DAMPED = {"stretch_damping_time": 1e-5, "bending_damping_time": 1e-2}
HYSTERETIC = {"stretch_loss_factor": 0.1, "bending_loss_factor": 0.3}
PRESSED = {"compression_loss_factor": 1.0, "contact_stiffness": 1e6}
MACHINES = [("rotary", DAMPED), ("sliding", DAMPED), ("rotary", HYSTERETIC), ("sliding", HYSTERETIC)]


@pytest.fixture(params=MACHINES, ids=lambda variant: f"{variant[0]}-{next(iter(variant[1]))}")
def machines(request: pytest.FixtureRequest, with_machines: Callable[[str], Drive]) -> tuple[System, State]:
    """A drive with losses in the belt, a tensioner on its stop, a hub chain and loads, disturbed."""
    tensioner, losses = request.param
    drive = with_machines(tensioner)
    system = drive_system(prepare(drive.replace(belt=drive.belt.replace(**losses, **PRESSED))))
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 1e-4), np.array([-2e-3])).position
    scale = np.concatenate([np.tile(1.0 / np.array(system.scale), system.nodes), 1.0 / system.bodies.reach])
    noise = np.random.default_rng(1).normal(size=(2, rest.size)) * scale
    noise[0, -1] = 0.0
    return system, State(rest + 3e-4 * noise[0], 0.1 * noise[1], 0.0 * rest)


def test_energy_of_a_drive_with_machines(machines: tuple[System, State]) -> None:
    system, state = machines
    powers = rates(system, state)[2]
    assert np.all(np.abs(np.delete(powers, POWERS.index("carrying_loss"))) > 1e-3)
    assert powers[POWERS.index("carrying_loss")] == 0.0  # nothing carries the belt
    assert_energy_closes(at_points(system), state)


def assert_momentum(system: System, state: State) -> None:
    """Force and moment about the origin of pulleys and weight on the belt change its momentum and its moment."""
    velocity, acceleration, _ = rates(system, state)
    seen, belt = see(system, TIME, state.position, velocity), slice(0, system.first_body)
    change = mass_matrix(system) @ acceleration[belt] - system.supports.force
    vectors = state.position[belt].reshape(-1, 2)
    turned = np.stack([-vectors[:, 1], vectors[:, 0]], axis=1).ravel()
    places = np.tile(np.arange(len(system.scale)) < 2 * system.points, system.nodes)
    total = [change[places][axis::2].sum() for axis in (0, 1)]
    hub, center = seen.hub_force[0], seen.pulley_center[0]
    size = np.abs(change).max()
    np.testing.assert_allclose(total, -hub.sum(axis=0), atol=1e-9 * size)  # rounding of the inverse mass matrix
    moment = seen.pulley_torque[0] + center[:, 0] * hub[:, 1] - center[:, 1] * hub[:, 0]
    assert turned @ change == pytest.approx(-moment.sum(), abs=1e-9 * size)
    assert np.abs(hub).max() > 1.0


def test_momentum_of_the_belt(system: System, joined: State) -> None:
    assert_momentum(system, joined)


def test_momentum_of_the_belt_of_a_drive_with_machines(machines: tuple[System, State]) -> None:
    """Without rolling resistance, whose couple about the shaft goes to the frame."""
    system, state = machines
    pulleys = system.pulleys.copy()
    pulleys.rolling = 0.0
    assert_momentum(system._replace(pulleys=pulleys), state)


def test_bodies_follow_their_torques(machines: tuple[System, State]) -> None:
    """Inertia times acceleration is the torque of belt, chain and shaft; a driver gives what is missing."""
    system, state = machines
    velocity, acceleration, powers = rates(system, state)
    forces = body_forces_at(system, np.array([TIME]), state.position[None].copy(), velocity[None].copy())
    free, bodies = system.bodies.unknown >= 0, slice(system.first_body, None)
    inertia = system.bodies.inertia
    np.testing.assert_allclose(inertia[free] * acceleration[bodies][free], forces.force[0, free], rtol=1e-12)
    np.testing.assert_allclose(forces.power[0], powers, rtol=1e-12)
    driver = np.flatnonzero(~free)
    torque = inertia[driver] * acceleration[bodies][driver] - forces.force[0, driver]
    np.testing.assert_allclose(forces.shaft[0, :1], torque, rtol=1e-12)
    np.testing.assert_allclose(forces.power[0, POWERS.index("driver_work")], torque @ velocity[bodies][driver])


def test_loads_of_several_states(machines: tuple[System, State]) -> None:
    """Each row belongs to its state: those before leave nothing."""
    system, state = machines
    times = np.array([0.1, TIME, 0.5])
    position = np.stack([state.position, state.position + 1e-3, state.position])
    velocity = np.stack([state.velocity, 2.0 * state.velocity, 0.0 * state.velocity])
    together = body_forces_at(system, times, position.copy(), velocity.copy())
    for k in range(3):
        alone = body_forces_at(system, times[k : k + 1], position[k : k + 1].copy(), velocity[k : k + 1].copy())
        for name, values in together._asdict().items():
            np.testing.assert_array_equal(values[k], getattr(alone, name)[0], err_msg=name)
            assert np.any(values)
    seen = observe(system, times, position.copy(), velocity.copy())
    np.testing.assert_allclose(
        seen.friction_power.sum(axis=1), together.power[:, POWERS.index("friction_loss")], rtol=1e-12
    )
    np.testing.assert_allclose(
        seen.contact_damping_power.sum(axis=1), together.power[:, POWERS.index("damping_loss")], rtol=1e-12
    )


def test_energies_of_the_states_that_are_shown(machines: tuple[System, State]) -> None:
    """Energies and tensions of the belt are there for these states alone, all else for every state."""
    system, state = machines
    times, shown = np.array([0.1, TIME, 0.5]), np.array([False, True, True])
    position = np.stack([state.position + shift for shift in (0.0, 1e-4, -1e-4)])
    velocity = np.stack([factor * state.velocity for factor in (1.0, 2.0, -1.0)])
    whole = observe(system, times, position, velocity)
    forces = body_forces_at(system, times, position, velocity)
    some = observe_motion(system, position, velocity, forces, shown)
    for name, per in OBSERVED.items():
        expected = getattr(whole, name)[shown] if per.shown else getattr(whole, name)
        np.testing.assert_array_equal(getattr(some, name), expected, err_msg=name)

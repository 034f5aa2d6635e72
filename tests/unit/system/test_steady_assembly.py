"""Equations of steady running: tangent by differences, a hoop that spins freely; accelerations leave no residual."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import Belt, Constant, Drive, Path, Pulley, prepare
from beltdyn.model.resolution import Laid
from beltdyn.solvers.engine import accelerate
from beltdyn.state.newton import SteadyWork, steady_work
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import NO_TANGENT, Motion, System
from beltdyn.system.build import belt_system, staying_system
from beltdyn.system.constant_drive import constant_drive, drive_shafts, with_speeds_unknown
from beltdyn.system.frame import staying
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State, at_rest, nodal_coordinates, point_coordinates, straight
from beltdyn.system.steady_assembly import (
    Anchor,
    anchor_at,
    assemble,
    assemble_steady,
    new_equations,
    subtract_multipliers,
    subtract_solution,
)

SPEED = 3.0


def residual(system: System, state: State, anchor: Anchor, work: SteadyWork, wanted: bool = False) -> FloatArray:
    interpreted(assemble_steady)(system, state.at(0.0), anchor, wanted, work.equations)
    matrix = work.equations.matrix
    return np.concatenate([matrix.node_side.ravel(), matrix.border_side])


@pytest.mark.parametrize(
    ("tensioner", "law", "losses"),
    [
        ("rotary", "force_slope", "lossless"),
        ("sliding", "relative_creep", "lossless"),
        ("rotary", "coefficient_slope", "damping"),
        ("sliding", "force_slope", "hysteresis"),
        pytest.param("sliding", "force_slope", "lossless", marks=pytest.mark.slow),
        pytest.param("rotary", "relative_creep", "lossless", marks=pytest.mark.slow),
        pytest.param("sliding", "coefficient_slope", "damping", marks=pytest.mark.slow),
        pytest.param("rotary", "force_slope", "hysteresis", marks=pytest.mark.slow),
    ],
)
def test_tangent(with_machines: Callable[..., Drive], tensioner: str, law: str, losses: str) -> None:
    """Along any direction of all unknowns, in contact that damps, creeps and slides, to the floor of differences."""
    drive = with_machines(tensioner, losses)
    if law != "force_slope":
        own = {"coefficient_slope": {"creep_velocity": 0.5}, "relative_creep": {"creep_ratio": 0.15}}[law]
        contact = drive.contact.model_dump(exclude_none=True) | {"friction_law": law} | own
        contact.pop("creep_rate_factor")
        drive = drive.replace(contact=contact)
    base = staying_system(prepare(drive), np.full(16, drive.belt_length / 16))
    system = with_speeds_unknown(constant_drive(base, 0.3))
    random = np.random.default_rng(5)
    drawn_in = Path(drive.path.centers, drive.path.radii - 1e-3 * np.sign(drive.path.radii))
    state = laid_state(Laid.on(drawn_in, drive.belt_length, 0), system, np.array([2e-3]))
    state.position[: system.first_body] += 2e-4 * random.normal(size=system.first_body)
    system.frame.speed[0] = SPEED
    bodies = slice(system.first_body, system.first_body + system.bodies.size - 1)
    state.velocity[bodies] = SPEED / 0.08 * (1.0 + 0.02 * random.normal(size=system.bodies.size - 1))
    drive_shafts(system, state.velocity)
    state.velocity[-2] = state.velocity[-3]
    anchor, work = anchor_at(state, False), steady_work(system)
    residual(system, state, anchor, work, wanted=True)
    rows, columns = places(work.equations.matrix)
    size = system.first_body + work.equations.border_part.size
    tangent = np.zeros((size, size))
    np.add.at(tangent, (rows, columns), entries(work.equations.matrix))

    def at(change: FloatArray) -> FloatArray:
        moved = State(state.position.copy(), state.velocity.copy(), state.acceleration)
        moved.position[: system.first_body] += change[: system.first_body]
        border = change[system.first_body :]
        for body, unknown in enumerate(system.bodies.unknown):
            if unknown >= 0:
                vector = moved.position if body == system.bodies.size - 1 else moved.velocity
                vector[system.first_body + body] += border[unknown]
        system.frame.speed[0] = SPEED + border[-1]
        found = residual(system, moved, anchor, work)
        system.frame.speed[0] = SPEED
        return found

    scale = np.concatenate([np.tile([1.0, 1.0, 10.0, 10.0, 100.0, 100.0], system.nodes), np.full(size, 100.0)])[:size]
    for _ in range(3):
        way = 1e-8 * scale * random.normal(size=size)
        difference = 0.5 * (at(way) - at(-way))
        np.testing.assert_allclose(tangent @ way, difference, rtol=2e-4, atol=2e-6 * np.abs(difference).max())


def test_a_free_hoop(drive: Drive) -> None:
    """A ring that spins at a speed c in its plane, free of forces: EA (G - 1) / 2 = m c^2, G its squared stretch."""
    belt = drive.belt.replace(discretization="quintic", elements=16, quadrature_points=8, bending_factor=1e-9)
    given = belt_system(belt, closure="shared_node")
    system = given._replace(frame=staying(given.control, given.length, belt.mass_per_length))
    system.frame.speed[0] = 20.0
    force = belt.mass_per_length * 20.0**2
    stretch = np.sqrt(1.0 + 2.0 * force / belt.axial_stiffness)
    radius = stretch * belt.given_length / (2.0 * np.pi)
    angle = 2.0 * np.pi * point_coordinates(system) / belt.given_length
    out, along = np.stack([np.cos(angle), np.sin(angle)], 1), np.stack([-np.sin(angle), np.cos(angle)], 1)
    state = at_rest(system, nodal_coordinates(system, radius * out, stretch * along, -(stretch**2) / radius * out))
    found = residual(system, state, anchor_at(state, False), steady_work(system))
    np.testing.assert_allclose(found, 0.0, atol=1e-5 * force)
    system.frame.speed[0] = 22.0
    assert np.abs(residual(system, state, anchor_at(state, False), steady_work(system))).max() > 0.05 * force


TIME = 0.3


def test_accelerations_leave_no_residual(system: System, moving: State) -> None:
    equations = new_equations(system)
    motion = Motion(TIME, moving.position, moving.velocity.copy(), np.empty_like(moving.position))
    multipliers = np.empty(len(system.scale))
    assert accelerate(system, motion, multipliers, equations)
    forces = np.max(np.abs(equations.matrix.node_side))
    assemble(system, motion, multipliers, NO_TANGENT, equations)
    np.testing.assert_allclose(equations.matrix.node_side, 0.0, atol=1e-10 * forces)  # rounding
    np.testing.assert_allclose(equations.matrix.border_side, 0.0, atol=1e-10 * forces)


def test_prescribed_pulley_keeps_its_profile(small: Drive, system: System, moving: State) -> None:
    equations = new_equations(system)
    motion = Motion(TIME, moving.position, moving.velocity.copy(), np.empty_like(moving.position))
    accelerate(system, motion, np.empty(len(system.scale)), equations)
    speed = small.pulleys[0].speed
    assert speed is not None
    assert motion.velocity[-2] == pytest.approx(float(speed.at(TIME)))
    assert motion.acceleration[-2] == pytest.approx(12.0 / 0.55)


@pytest.fixture
def untouched(drive: Drive) -> Callable[[Pulley], System]:
    """An open belt, straight and far from a pulley."""
    belt = Belt(**drive.belt.model_dump() | {"elements": 3})
    return lambda pulley: belt_system(belt, [pulley], drive.contact)


def test_free_pulley_turns_by_torque_over_inertia(untouched: Callable[[Pulley], System]) -> None:
    system = untouched(Pulley(name="far", center=(0, 50), radius=0.1, inertia=0.4, torque=Constant(value=-2.0)))
    state, equations = straight(system), new_equations(system)
    assert accelerate(system, state.at(TIME), np.empty(len(system.scale)), equations)
    np.testing.assert_allclose(state.acceleration[:-1], 0.0, atol=1e-7)  # rounding of 1e4 N on grams
    assert state.acceleration[-1] == pytest.approx(-5.0)


def test_massless_belt_is_singular(untouched: Callable[[Pulley], System]) -> None:
    system = untouched(Pulley(name="far", center=(0, 50), radius=0.1, inertia=0.4))
    system = system._replace(mass=0.0 * system.mass)
    state = straight(system)
    assert not accelerate(system, state.at(TIME), np.empty(len(system.scale)), new_equations(system))


def test_subtraction_leaves_prescribed_pulleys(system: System, moving: State) -> None:
    equations = new_equations(system)
    equations.node_part[:], equations.border_part[:] = 1.0, np.arange(equations.border_part.size)
    vector, multipliers = moving.position.copy(), np.zeros(len(system.scale))
    subtract_solution(system, equations, 0.5, vector)
    subtract_multipliers(system, equations, 0.5, multipliers)
    np.testing.assert_allclose(moving.position[:-2] - vector[:-2], 0.5)
    np.testing.assert_array_equal(vector[-2:], moving.position[-2:])
    np.testing.assert_array_equal(multipliers, -0.5 * np.arange(1, 7) if system.joint else 0.0)

"""The carriage in the equations: exact tangent, ends that follow it, and work of its forces."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import Drive, prepare
from beltdyn.solvers.flutter import Vibrations
from beltdyn.system.arrays import SPRING_ENERGY, TORQUE_WORK, Equations, Motion, System, TangentFactors
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import drive_system, flowing_system, staying_system
from beltdyn.system.frame import FlowingByArcs
from beltdyn.system.guide import Guided, carry_ends
from beltdyn.system.ring_matrix import entries
from beltdyn.system.state import laid
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

DRIVE = Drive(
    belt={
        "width": 0.02,
        "thickness": 0.002,
        "axial_stiffness": 1e5,
        "bending_stiffness": 1e-3,
        "mass_per_length": 0.05,
        "length": 1.09,
        "elements": 24,
        "discretization": "ancf",
    },
    pulley=[
        {"name": "motor", "center": [0.0, 0.0], "radius": 0.04, "inertia": 1e-4, "torque": 0.1},
        {"name": "idler", "center": [0.5, 0.1], "radius": 0.04, "inertia": 1e-4},
    ],
    carriage={
        "center": [0.25 - 0.041 * np.sin(np.arctan2(0.1, 0.5)), 0.05 + 0.041 * np.cos(np.arctan2(0.1, 0.5))],
        "direction": [0.5, 0.1],
        "length": 0.1,
        "mass": 2.0,
        "friction": 3.0,
        "creep_speed": 0.5,
        "damping": 4.0,
        "force": {"kind": "ramp", "start": 0.0, "end": 1.0, "value": 20.0},
        "stroke": [-0.01, 0.02],
        "stop_stiffness": 1e4,
        "stop_damping": 5.0,
    },
    contact={"friction": 0.5, "stiffness": 1e3},  # soft: what begins to touch hardly counts
    gravity=(0.0, -9.81),
    simulation={"duration": 1.0},
)


@pytest.fixture(scope="module")
def system() -> System:
    return drive_system(prepare(DRIVE))


def place(system: System, way: float, speed: float, rng: np.random.Generator) -> Motion:
    """A state near the laid belt, with the carriage on its way and both ends where it holds them."""
    state = laid(system, prepare(DRIVE).path)
    position, velocity = state.position.copy(), 0.1 * rng.standard_normal(state.velocity.size)
    position += 1e-5 * rng.standard_normal(position.size)
    u, dof = system.carriage.table[0].direction, len(system.scale)
    position[-1], velocity[-1] = way, speed
    for end in (0, system.nodes - 1):
        position[dof * end : dof * end + 2] = state.position[dof * end : dof * end + 2] + way * u
        velocity[dof * end : dof * end + 2] = speed * u
    acceleration = rng.standard_normal(position.size)
    return Motion(0.5, position, velocity, acceleration)


def moved(system: System, motion: Motion, step: FloatArray, factors: TangentFactors, size: float) -> Motion:
    return Motion(
        motion.time,
        motion.position + size * factors.by_position * step,
        motion.velocity + size * factors.by_velocity * step,
        motion.acceleration + size * factors.by_acceleration * step,
    )


def residual(system: System, motion: Motion, factors: TangentFactors) -> tuple[FloatArray, FloatArray, Equations]:
    equations = new_equations(system)
    interpreted(assemble)(system, motion, no_multipliers(system), factors, equations)
    return equations.matrix.node_side.copy(), equations.matrix.border_side.copy(), equations


@pytest.mark.parametrize("way", [0.005, 0.0203, -0.0104])
def test_the_tangent_is_the_derivative_of_the_residual(system: System, way: float) -> None:
    """On the free way and in both stops; the step moves the ends as the carriage does."""
    rng = np.random.default_rng(1)
    motion, factors = place(system, way, 0.2, rng), TangentFactors(1.0, 3.0, 0.5)
    vibrations = Vibrations(system)
    dof, free = len(system.scale), system.first_body
    step = rng.standard_normal(motion.position.size)
    u = system.carriage.table[0].direction
    for end in (0, system.nodes - 1):
        step[dof * end : dof * end + 2] = step[-1] * u
    *_, equations = residual(system, motion, factors)
    tangent = vibrations.matrix(entries(equations.matrix)).toarray()
    ahead, behind = (
        np.concatenate(
            [part.ravel() for part in residual(system, moved(system, motion, step, factors, size), factors)[:2]]
        )
        for size in (1e-6, -1e-6)
    )
    difference = (ahead - behind) / 2e-6
    found = tangent @ step
    assert np.all(system.bodies.unknown >= 0)
    assert found == pytest.approx(difference, rel=1e-4, abs=1e-5 * np.abs(difference).max())
    assert free == dof * system.nodes


def test_no_belt_flows_past_ends_that_a_carriage_holds() -> None:
    """On a mesh that stays at the arcs the flow at the first node is held in place of the belt."""
    prepared = prepare(DRIVE)
    system = flowing_system(staying_system(prepared, prepared.equal_lengths(12)), np.array([1.0, 0.0]))
    assert isinstance(system.frame, FlowingByArcs)
    rng, zero = np.random.default_rng(4), np.zeros(system.first_body + system.bodies.size)
    motion, matrix = Motion(0.5, zero, zero, rng.standard_normal(zero.size)), new_equations(system).matrix
    interpreted(carry_ends)(system.carriage, system, motion, TangentFactors(1.0, 3.0, 0.5), True, matrix)
    assert matrix.border_side[-1] == motion.acceleration[system.frame.place]
    assert matrix.corner[-1, -1] == 0.5


def test_only_a_carriage_frees_the_ends(system: System) -> None:
    assert isinstance(system.carriage, Guided)
    assert not system.supports.fixed.any()
    assert system.bodies[-1].inertia == 2.0
    assert DRIVE.carriage is not None
    without = drive_system(prepare(DRIVE.replace(carriage=None, end=DRIVE.carriage.ends((0.0, 0.0)))))
    assert without.supports.fixed.sum() == 4


@pytest.mark.slow
def test_force_guide_and_weight_on_the_carriage(system: System) -> None:
    """F + m g u - f tanh(v / v_c) - c v, and their power but that of the weight, which is stored."""
    motion = place(system, 0.005, 0.2, np.random.default_rng(2))
    seen = body_forces_at(system, np.array([0.5]), motion.position[None].copy(), motion.velocity[None].copy())
    u = system.carriage.table[0].direction
    dry, weight = 3.0 * np.tanh(0.4), -2.0 * 9.81 * u[1]
    assert seen.force[0, -1] == pytest.approx(10.0 + weight - dry - 0.8)
    assert DRIVE.carriage is not None
    without = DRIVE.replace(carriage=DRIVE.carriage.replace(force=None, friction=0.0, damping=0.0))
    free = body_forces_at(
        drive_system(prepare(without)), np.array([0.5]), motion.position[None].copy(), motion.velocity[None].copy()
    )
    assert seen.power[0, TORQUE_WORK] - free.power[0, TORQUE_WORK] == pytest.approx(0.2 * (10.0 - dry - 0.8))
    assert seen.stored[0, SPRING_ENERGY] == pytest.approx(-weight * 0.005)

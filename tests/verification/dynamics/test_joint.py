"""Closing the belt by a shared node (Eq. 27) and by Lagrange multipliers (Eqs. 25 and 26): the same motion."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, prepare
from beltdyn.solvers.engine import accelerate
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import NO_TANGENT, Motion, System
from beltdyn.system.build import drive_system
from beltdyn.system.first_order import joint_constraint
from beltdyn.system.state import laid
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

Change = Callable[..., Drive]
Measured = Callable[..., None]
TIME = 0.01


@pytest.fixture(scope="module")
def tied(small: Drive, change: Change) -> Drive:
    return change(small, simulation={"joint": "multipliers"})


@pytest.fixture(scope="module")
def nodes(small: Drive) -> FloatArray:
    """Positions and velocities of the nodes in contact and motion, shape (2, N, 6)."""
    system = drive_system(prepare(small))
    rest = find_equilibrium(system, laid(system, small.path)).state.nodes(system)
    noise = np.random.default_rng(0).normal(size=(2, *rest.shape)) * np.array([1, 1, 8, 8, 8, 8])
    return np.stack([rest + 1e-4 * noise[0], 0.1 * noise[1]])


def accelerations(system: System, position: FloatArray, velocity: FloatArray) -> FloatArray:
    """Of nodes, shape (N, 6), by the ring solver."""
    result, pulleys = np.empty(position.size + 2), np.zeros(2)
    where, how = np.append(position, pulleys), np.append(velocity, pulleys)
    motion = Motion(TIME, where, how, result)
    assert accelerate(system, motion, no_multipliers(system), new_equations(system))
    return result[:-2].reshape(-1, 6)


def test_accelerations(small: Drive, tied: Drive, nodes: FloatArray, measured: Measured) -> None:
    shared, joined = drive_system(prepare(small)), drive_system(prepare(tied))
    doubled = np.concatenate([nodes, nodes[:, :1]], axis=1)
    by_node, by_multipliers = accelerations(shared, *nodes), accelerations(joined, *doubled)
    equations, zero = new_equations(joined), np.zeros(doubled[0].size + 2)
    position, velocity = np.append(doubled[0], [0, 0]), np.append(doubled[1], [0, 0])
    velocity[-2] = small.pulleys[0].speed.at(TIME)  # type: ignore[union-attr]
    assemble(joined, Motion(TIME, position, velocity, zero), no_multipliers(joined), NO_TANGENT, equations)
    by_brackets = joint_constraint(joined).accelerations(-equations.matrix.node_side.ravel()).reshape(-1, 6)
    size = np.max(np.abs(by_node))
    differences = {
        "equation_25": np.max(np.abs(by_multipliers[:-1] - by_node)) / size,
        "equation_26": np.max(np.abs(by_brackets[:-1] - by_node)) / size,
        "joint": np.max(np.abs(by_multipliers[0] - by_multipliers[-1])) / size,
    }
    measured(**differences)
    assert max(differences.values()) < 1e-9


@pytest.mark.parametrize("start", ["equilibrium", "laid"])
@pytest.mark.parametrize("rtol", [1e-3, 1e-5])
def test_trajectories(small: Drive, change: Change, measured: Measured, start: str, rtol: float) -> None:
    settings = {"start": start, "duration": 0.01, "rtol": rtol}
    runs = [
        simulate(change(small, simulation=settings | {"joint": joint})).dataset
        for joint in ("shared_node", "multipliers")
    ]
    first, tied = (run.node_position.values for run in runs)
    place = float(np.max(np.abs(tied[:, :-1] - first))) / small.belt_length
    speed = float(np.max(np.abs(runs[1].pulley_speed - runs[0].pulley_speed))) / 12.0
    parting = float(np.max(np.abs(tied[:, -1] - tied[:, 0])))
    measured(place=place, speed=speed, parting=parting)
    assert max(place, speed) < rtol  # the node that counts twice in the norms changes the steps
    assert parting < 1e-14  # rounding: the joint is linear in the coordinates


def test_trajectories_with_equal_steps(
    small: Drive, tied: Drive, fixed_steps: Callable[..., tuple[FloatArray, FloatArray]], measured: Measured
) -> None:
    times = np.linspace(0.0, 0.02, 21)[1:]
    systems = [drive_system(prepare(small)), drive_system(prepare(tied))]
    rest = find_equilibrium(systems[0], laid(systems[0], small.path)).state.position
    node, belt = len(systems[0].scale), systems[0].first_body
    starts = [rest, np.concatenate([rest[:belt], rest[:node], rest[belt:]])]  # a belt may lie anywhere along itself
    by_node, by_multipliers = (fixed_steps(s, q, 0.8, 100, times) for s, q in zip(systems, starts, strict=True))
    place = float(np.max(np.abs(by_multipliers[0][:, : starts[0].size - 2] - by_node[0][:, :-2])))
    speed = float(np.max(np.abs(by_multipliers[1][:, -2:] - by_node[1][:, -2:])))
    measured(place=place, speed=speed)
    assert place < 1e-11  # Newton's tolerance, over 100 steps with friction
    assert speed < 1e-9

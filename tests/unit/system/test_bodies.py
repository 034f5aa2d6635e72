"""A drive with hub chains, loads and a tensioner: its tangent, the balance of its forces, its bodies as arrays."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, prepare
from beltdyn.system.arrays import (
    COUPLING_LOSS,
    TENSIONER_LOSS,
    TORQUE_WORK,
    Equations,
    RingMatrix,
    System,
    TangentFactors,
)
from beltdyn.system.build import drive_system
from beltdyn.system.observe import observe
from beltdyn.system.state import State, laid
from beltdyn.system.steady_assembly import assemble, border_size, new_equations, no_multipliers

Dense = Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]]

IDLER, FIRST_HUB, SECOND_HUB, TENSIONER = 2, 3, 4, 5
"""Numbers of bodies."""


@pytest.fixture(scope="module", params=["rotary", "sliding"])
def system(request: pytest.FixtureRequest, with_machines: Callable[[str], Drive]) -> System:
    return drive_system(prepare(with_machines(request.param)))


@pytest.fixture(scope="module")
def scale(system: System) -> FloatArray:
    return np.concatenate([np.tile(1.0 / np.array(system.scale), system.nodes), 1.0 / system.bodies.reach])


@pytest.fixture(scope="module")
def moving(system: System, scale: FloatArray) -> State:
    """In real contact, disturbed, with a turning arm that rests on its lower stop."""
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 1e-4), np.array([-2e-3])).position
    noise = np.random.default_rng(1).normal(size=(3, rest.size)) * scale
    noise[0, -1] = 0.0
    return State(rest + 3e-4 * noise[0], 0.1 * noise[1], 10.0 * noise[2])


def residual(system: System, state: State, equations: Equations, factors: tuple[float, float, float]) -> RingMatrix:
    assemble(system, state.at(0.3), no_multipliers(system), TangentFactors(*factors), equations)
    return equations.matrix


@pytest.mark.parametrize(
    "factors",
    [(1.0, 0.0, 1e-9), (0.0, 1.0, 1e-9), (0.0, 0.0, 1.0), (1.0, 2e3, 1e6)],
    ids=["position", "velocity", "acceleration", "step"],
)
def test_tangent(
    system: System, moving: State, scale: FloatArray, dense: Dense, factors: tuple[float, float, float]
) -> None:
    """The bodies' rows and columns to the floor of central differences, apart from the far larger ones of the belt."""
    equations = new_equations(system)
    tangent = dense(residual(system, moving, equations, factors), True)[0].copy()
    unknowns = [*range(system.first_body), *(system.first_body + np.flatnonzero(system.bodies.unknown >= 0))]
    step = 1e-8 / max(factors[0], factors[1] / 1e3, factors[2] / 1e6)

    def at(unknown: int, side: float) -> FloatArray:
        change = np.zeros_like(scale)
        change[unknown] = side * step * scale[unknown]
        motion = (moving.position, moving.velocity, moving.acceleration)
        moved = State(*(part + factor * change for part, factor in zip(motion, factors, strict=True)))
        return dense(residual(system, moved, equations, (0.0, 0.0, 0.0)), True)[1].copy()

    found = np.transpose([(at(k, 1.0) - at(k, -1.0)) / (2 * step * scale[k]) for k in unknowns])
    for part in (slice(None), slice(system.first_body, None)):
        for block in ((part, slice(None)), (slice(None), part)):
            rounding = 1e-7 * np.max(np.abs(tangent[block]))
            np.testing.assert_allclose(tangent[block], found[block], atol=rounding, rtol=0)


def test_residual_alone_keeps_the_tangent(system: System, moving: State, dense: Dense) -> None:
    equations = new_equations(system)
    tangent = dense(residual(system, moving, equations, (1.0, 2e3, 1e6)), True)[0].copy()
    np.testing.assert_array_equal(dense(residual(system, moving, equations, (0.0, 0.0, 0.0)), True)[0], tangent)


def test_only_the_prescribed_shaft_is_no_unknown(system: System) -> None:
    assert np.count_nonzero(system.bodies.unknown < 0) == 1
    assert border_size(system) == system.bodies.unknown.size - 1 == 5


def test_couplings_act_on_both_bodies(system: System, moving: State) -> None:
    """Without belt and shaft torques, what a chain does to its bodies adds up to nothing."""
    lifted = State(moving.position.copy(), moving.velocity, moving.acceleration)
    lifted.position[: system.first_body] += 10.0
    equations = new_equations(system)
    residual(system, lifted, equations, (0.0, 0.0, 0.0))
    forces = equations.forces
    assert np.all(forces.moment == 0.0)
    chain = forces.force[:TENSIONER].sum() - forces.shaft[np.flatnonzero(system.pulleys.shaft == SECOND_HUB)[0]]
    assert abs(forces.force[FIRST_HUB]) > 0.1
    assert chain == pytest.approx(0.0, abs=1e-12)


def test_power_of_the_bodies_is_what_is_lost_and_stored(system: System, moving: State) -> None:
    """Work of all forces on the bodies but the belt's = torque work - losses - rate of the springs' energy."""
    equations, bodies = new_equations(system), slice(system.first_body, None)
    lifted = State(moving.position.copy(), moving.velocity.copy(), moving.acceleration)
    lifted.position[: system.first_body] += 10.0

    def energy(time: float) -> float:
        place = (lifted.position + time * lifted.velocity)[None]
        seen = observe(system, np.zeros(1), place, lifted.velocity[None].copy())
        belt = system.supports.force @ place[0, : system.first_body]
        return float(seen.spring_energy[0] + seen.potential_energy[0] + belt)

    residual(system, lifted, equations, (0.0, 0.0, 0.0))
    rate = (energy(1e-6) - energy(-1e-6)) / 2e-6
    forces, velocity = equations.forces, lifted.velocity[bodies]
    lost = forces.power[[TENSIONER_LOSS, COUPLING_LOSS]]
    torque_work, losses = forces.power[TORQUE_WORK], lost.sum()
    free = system.bodies.unknown >= 0
    assert (lost > 0.0).all()
    assert forces.force[free] @ velocity[free] == pytest.approx(torque_work - losses - rate, rel=1e-7)


def test_the_carried_pulley_moves(system: System, moving: State) -> None:
    seen = observe(system, np.zeros(1), moving.position[None], moving.velocity[None].copy())
    carried = int(system.tensioners.pulley[0])
    moved = seen.pulley_center[0] - system.pulleys.center
    assert np.linalg.norm(moved[carried]) == pytest.approx(2e-3 * system.bodies.reach[TENSIONER], rel=1e-3)
    np.testing.assert_array_equal(np.delete(moved, carried, axis=0), 0.0)

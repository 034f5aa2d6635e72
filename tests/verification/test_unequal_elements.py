"""Verified: belts of elements of unequal length, from assembly and contact to observation and results.

Against: slopes of energies, central differences of forces, rigid motion, and meshes of equal elements.  The lengths
rise and fall along the belt, and the longest element is three times as long as the shortest.
"""

from collections.abc import Callable
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive, Path, prepare
from beltdyn.observation.recording import Recording, result_layout
from beltdyn.results import Run
from beltdyn.results.derived.contact_profile import wear_by_belt
from beltdyn.solvers.trajectory import drive_task
from beltdyn.state.static import find_equilibrium, standing
from beltdyn.system.arrays import NO_TANGENT, Equations, System, TangentFactors
from beltdyn.system.build import belt_system
from beltdyn.system.observe import observe
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State, belt_section, laid, straight
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers
from beltdyn.transient.simulate import choose_integrator

Cut = Callable[..., Drive]
Measured = Callable[..., None]
EXACT = 1e-12
STEP = 1e-8
"""m; rounding and truncation of central differences are then both near 1e-8 of the largest entry."""


def lengths_of(belt: Belt) -> FloatArray:
    along = (np.arange(belt.given_elements) + 0.8) / belt.given_elements
    share = 2.0 + np.cos(2.0 * pi * along)
    return np.asarray(belt.given_length * share / share.sum())


def system_of(drive: Drive, lengths: FloatArray | None) -> System:
    return belt_system(drive.belt, drive.pulleys, drive.contact, "shared_node", lengths=lengths)


def graded(drive: Drive) -> System:
    return system_of(drive, lengths_of(drive.belt))


@pytest.fixture(scope="module", params=["ancf", pytest.param("quintic", marks=pytest.mark.slow)])
def cut(request: pytest.FixtureRequest, drive: Drive) -> Cut:
    """The paper's drive with a number of elements of a kind."""

    def made(elements: int, integration: str = "zone") -> Drive:
        belt = drive.belt.replace(discretization=request.param, elements=elements)
        return drive.replace(belt=belt, contact=drive.contact.replace(integration=integration))

    return made


class Shaken(NamedTuple):
    """A belt 0.4 mm deep in its pulleys, disturbed by 0.1 mm, 0.1 m/s and 10 m/s^2."""

    system: System
    state: State
    metre: FloatArray
    """Changes of the coordinates that make a meter."""


def shaken(drive: Drive) -> Shaken:
    system = graded(drive)
    metre = np.concatenate([np.tile(1.0 / np.array(system.scale), system.nodes), 1.0 / system.bodies.reach])
    noise = metre * np.random.default_rng(3).normal(size=(3, metre.size))
    sunk = laid(system, Path(system.pulleys.center, system.pulleys.radius - 4e-4)).position
    return Shaken(system, State(sunk + 1e-4 * noise[0], 0.1 * noise[1], 10.0 * noise[2]), metre)


def assembled(system: System, state: State, factors: TangentFactors = NO_TANGENT) -> Equations:
    equations = new_equations(system)
    assemble(system, state.at(0.3), no_multipliers(system), factors, equations)
    return equations


def test_forces_are_the_slope_of_the_energies(cut: Cut) -> None:
    """With contact at points that stay: points that follow the zone of contact add their errors to the slope."""
    system, state, metre = shaken(cut(12, "fixed"))
    still = np.zeros_like(state.position)

    def energy(position: FloatArray) -> float:
        seen = observe(system, np.zeros(1), position[None].copy(), still[None].copy())
        return float(seen.strain_energy[0] + seen.penalty_energy[0])

    moves = STEP * np.diag(metre)[: system.first_body]
    slopes = [(energy(state.position + move) - energy(state.position - move)) / (2.0 * STEP) for move in moves]
    resting = State(state.position, still, still)
    by_metre = assembled(system, resting).matrix.node_side.ravel() * metre[: system.first_body]
    np.testing.assert_allclose(by_metre, slopes, atol=1e-6 * np.abs(by_metre).max())  # rounding of joules over 1e-8 m


@pytest.mark.parametrize("factors", [(1.0, 0.0), (0.0, 1.0)], ids=["position", "velocity"])
def test_tangent(cut: Cut, factors: tuple[float, float]) -> None:
    system, state, metre = shaken(cut(12))
    step = STEP if factors[0] else 1e3 * STEP
    unknowns = np.flatnonzero(np.append(np.ones(system.first_body, bool), system.bodies.unknown >= 0))
    matrix = assembled(system, state, TangentFactors(*factors)).matrix
    tangent = np.zeros((unknowns.size, unknowns.size))
    np.add.at(tangent, places(matrix), entries(matrix))

    def residual(unknown: int, side: float) -> FloatArray:
        change = np.zeros_like(metre)
        change[unknown] = side * step * metre[unknown]
        moved = State(state.position + factors[0] * change, state.velocity + factors[1] * change, state.acceleration)
        found = assembled(system, moved).matrix
        return np.concatenate([found.node_side.ravel(), found.border_side])

    by_metre = metre[unknowns]
    found = np.transpose([residual(k, 1.0) - residual(k, -1.0) for k in unknowns.tolist()]) / (2.0 * step)
    np.testing.assert_allclose(tangent * by_metre, found, atol=1e-6 * np.abs(found).max(), rtol=0.0)


def test_a_turned_belt(cut: Cut) -> None:
    """Elastic forces turn with the belt, and its energy stays."""
    drive = cut(12)
    system, state, _ = shaken(drive)
    angle, nodes = 0.7, system.first_body
    turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    free = belt_system(drive.belt, closure="shared_node", lengths=system.length)
    turned = state.position.copy()
    turned[:nodes] = (turned[:nodes].reshape(-1, 2) @ turn).ravel()
    turned[:nodes].reshape(system.nodes, -1)[:, :2] += [0.4, -0.3]
    both = np.stack([state.position[:nodes], turned[:nodes]])
    seen = observe(free, np.zeros(2), both, 0.0 * both)
    assert seen.strain_energy[1] == pytest.approx(seen.strain_energy[0], rel=1e-10)
    before, after = (assembled(free, State(place, 0.0 * place, 0.0 * place)).matrix.node_side.ravel() for place in both)
    np.testing.assert_allclose(after, (before.reshape(-1, 2) @ turn).ravel(), atol=1e-10 * np.abs(before).max())


def test_inertia_of_rigid_motion(cut: Cut) -> None:
    """A straight belt that is shifted and turned about its middle: m v^2 / 2 + J omega^2 / 2."""
    belt = cut(9).belt
    system = belt_system(belt, lengths=lengths_of(belt))
    section, kind = belt_section(belt), belt.element_kind
    at_rest = straight(system)
    pairs = at_rest.position.reshape(-1, 2).copy()
    shift, spin = np.array([3.0, -2.0]), 5.0
    pairs.reshape(system.nodes, -1)[:, 0] -= 0.5 * belt.given_length
    velocity = spin * np.stack([-pairs[:, 1], pairs[:, 0]], axis=1)
    velocity.reshape(system.nodes, -1)[:, :2] += shift
    seen = observe(system, np.zeros(1), at_rest.position[None], velocity.reshape(1, -1))
    about_middle = section.mass * belt.given_length**3 / 12.0
    about_middle += section.rotary_inertia * belt.given_length if kind.name == "ancf" else 0.0
    expected = 0.5 * section.mass * belt.given_length * (shift @ shift) + 0.5 * about_middle * spin**2
    assert seen.kinetic_energy[0] == pytest.approx(expected, rel=EXACT)


def at_rest(drive: Drive, lengths: FloatArray | None) -> tuple[System, State]:
    system = standing(system_of(drive, lengths))
    return system, find_equilibrium(system, laid(system, drive.path)).state


def tension(system: System, state: State) -> float:
    """Mean along the belt, N."""
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    return float(np.average(seen.belt_tension[0], weights=system.length))


def test_belt_at_rest(cut: Cut, measured: Measured) -> None:
    """Tension converges to that of equal elements, with the second order of the length of elements at least.

    The longest of 30 elements are as long as 20 equal ones, with which quintic elements come within 1 % of the limit.
    """
    limit = tension(*at_rest(cut(240), None))
    coarse, fine = (tension(*at_rest(drive, lengths_of(drive.belt))) / limit - 1.0 for drive in (cut(30), cut(120)))
    measured(coarse=coarse, fine=fine)
    assert abs(coarse) < 0.01
    assert abs(fine) < abs(coarse) / 4.0**2


def test_observation_at_rest(cut: Cut) -> None:
    """A hub carries the tension of both spans; free points are spaced as in the unstretched belt, times the stretch.

    The strain varies within the elements, but is nowhere negative, nor twice its mean.
    """
    drive = cut(40)
    system, state = at_rest(drive, lengths_of(drive.belt))
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    hubs = np.abs(seen.hub_force[0, :, 0])
    np.testing.assert_allclose(hubs, hubs[0], rtol=1e-8)  # one force along the line of both centers
    np.testing.assert_allclose(seen.span_tension.sum(), hubs, rtol=0.01)  # mean tensions of few elements
    along, free = result_layout(prepare(drive), system).belt_coordinate, seen.contact_pulley[0] < 0
    ways = np.linalg.norm(np.diff(seen.contact_position[0], axis=0), axis=1) / np.diff(along)
    stretch = (1.0 + 2.0 * tension(system, state) / drive.belt.axial_stiffness) ** 0.5
    np.testing.assert_allclose(ways[free[1:] & free[:-1]], stretch, rtol=0.0, atol=stretch - 1.0)


def run_of(drive: Drive, lengths: FloatArray | None) -> Run:
    """A run from rest, with its results."""
    system = system_of(drive, lengths)
    start = find_equilibrium(standing(system), laid(system, drive.path)).state
    prepared = prepare(drive)
    with Recording(prepared, system, None, "Unequal elements", None) as recording:
        recording.start(prepared, system, ())
        for chunk in choose_integrator(drive)(drive_task(prepared, system, start, recording.statistics)):
            recording.take(chunk)
    return recording.run()


def test_results_of_a_run(cut: Cut, measured: Measured) -> None:
    """Speed and torque as on a finer mesh of equal elements; the wear of the belt is its friction work a meter."""
    coarse, fine = (
        drive.replace(simulation=drive.simulation.replace(duration=0.1, output_interval=1e-3))
        for drive in (cut(30), cut(60))
    )
    lengths = lengths_of(coarse.belt)
    run, reference = run_of(coarse, lengths), run_of(fine, None).dataset
    dataset = run.dataset
    np.testing.assert_allclose(dataset.node_coordinate, np.cumsum(lengths) - lengths, atol=EXACT)
    np.testing.assert_allclose(dataset.element_coordinate, np.cumsum(lengths) - 0.5 * lengths, atol=EXACT)
    speed = float(dataset.pulley_speed[-1, 1] / reference.pulley_speed[-1, 1]) - 1.0
    torque = float(dataset.pulley_torque[-20:, 1].mean() / reference.pulley_torque[-20:, 1].mean()) - 1.0
    closure = float(np.abs(dataset.energy_closure).max())
    measured(speed=speed, torque=torque, closure=closure)
    assert max(abs(speed), abs(torque)) < 0.005  # 30 equal elements of the paper err by 0.0024
    assert closure < 1e-4
    worn = float((wear_by_belt(run).values * lengths).sum())
    work = float(dataset.friction_work_on_belt[1:].sum())
    assert worn == pytest.approx(work, rel=1e-6)  # single precision
    assert float(dataset.friction_work_on_arc[1:].sum()) == pytest.approx(work, rel=1e-6)

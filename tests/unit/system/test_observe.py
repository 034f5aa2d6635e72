"""Observed quantities of states whose tension, wrap, speed and energy are known by hand or from sums over the belt."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import Drive, Path, install, prepare
from beltdyn.quadrature import gauss_points
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe, observe_motion
from beltdyn.system.state import State, laid

SPEED = 3.0


def see(system: System, position: FloatArray, velocity: FloatArray) -> Observations:
    return observe(system, np.zeros(1), position[None], velocity[None])


@pytest.fixture(scope="module")
def fine(drive: Drive) -> Drive:
    """The paper's drive with so many elements that its arcs are round."""
    return Drive(**drive.model_dump(by_alias=True) | {"belt": drive.belt.model_dump() | {"elements": 80}})


@pytest.fixture(scope="module", params=[0.0, SPEED], ids=["at rest", "shifting"])
def seen(request: pytest.FixtureRequest, fine: Drive) -> tuple[float, Observations]:
    """The belt in equilibrium on its pulleys, with a velocity of the whole belt to the right."""
    system = drive_system(prepare(fine))
    state = find_equilibrium(system, laid(system, fine.path)).state
    velocity = np.zeros_like(state.velocity)
    velocity[: system.first_body : len(system.scale)] = request.param
    return request.param, see(system, state.position, velocity)


@pytest.mark.parametrize("tensioner", ["sliding", "rotary"])
def test_potential_energy_falls_by_the_weight_of_what_moves(
    with_machines: Callable[..., Drive], tensioner: str
) -> None:
    """Of the belt, and of the pulley of a tensioner with what moves with it, along an oblique gravity."""
    drive = with_machines(tensioner).replace(gravity=(-3.0, -9.0))
    system = drive_system(prepare(drive))
    state, size = laid(system, drive.path), len(system.scale)
    positions = np.tile(state.position, (3, 1))
    positions[1, -1] += 0.02
    positions[2, : system.first_body] += np.tile([0.03, -0.05, *np.zeros(size - 2)], system.nodes)
    found = interpreted(observe)(system, np.zeros(3), positions, np.zeros_like(positions))
    energy, centers = found.potential_energy, found.pulley_center
    (carried,) = np.flatnonzero(np.linalg.norm(centers[1] - centers[0], axis=1) > 1e-3)
    weight = system.tensioners[0].weight
    mass = {"sliding": 1.5, "rotary": 0.4}[tensioner] + 0.3
    if tensioner == "sliding":
        np.testing.assert_allclose(weight, mass * np.array([-3.0, -9.0]))
    assert energy[1] - energy[0] == pytest.approx(-weight @ (centers[1] - centers[0])[carried], rel=1e-9)
    belt = drive.belt.mass_per_length * float(system.length.sum())
    assert energy[2] - energy[0] == pytest.approx(-belt * np.dot([-3.0, -9.0], [0.03, -0.05]), rel=1e-9)


def test_tension(fine: Drive, seen: tuple[float, Observations]) -> None:
    expected = install(fine).tension
    estimate = 6e-3  # bending stiffness and round corners, which the estimate leaves out: 5.5e-3 with 480 elements
    np.testing.assert_allclose(seen[1].span_tension[0], expected, rtol=estimate)
    np.testing.assert_allclose(seen[1].belt_tension[0], expected, rtol=0.05)  # spread of a cubic belt over its arcs


@pytest.mark.parametrize(
    ("discretization", "missing"), [("ancf", 1e-4), ("quintic", 1e-3), ("truss", 1e-4), ("three-node-beam", 1e-4)]
)
@pytest.mark.parametrize("elements", [36, 50])
def test_spans_pull_at_hubs_on_coarse_meshes(drive: Drive, discretization: str, elements: int, missing: float) -> None:
    """At rest each of two parallel spans pulls with half of the hub load, at its ends as on the mean.

    The mean of an axial force that swings within elements beside arcs errs by up to 1.2 %, that of quintic ones, whose
    bending swings too, by 0.3 %.
    """
    belt = drive.belt.model_dump() | {"elements": elements, "discretization": discretization}
    system = drive_system(prepare(coarse := Drive(**drive.model_dump(by_alias=True) | {"belt": belt})))
    here = see(system, (state := find_equilibrium(system, laid(system, coarse.path)).state).position, state.velocity)
    for name in ("span_tension", "span_tension_at_start", "span_tension_at_end"):
        np.testing.assert_allclose(getattr(here, name)[0], 0.5 * here.hub_force[0, 0, 0], rtol=missing, err_msg=name)


@pytest.mark.parametrize("seen", [0.0], ids=["at rest"], indirect=True)
def test_hub_loads_at_rest_are_twice_the_tension(seen: tuple[float, Observations]) -> None:
    here = seen[1]
    twice = 2.0 * here.span_tension[0]
    expected = np.stack([twice * [1.0, -1.0], [0.0, 0.0]], axis=1)
    np.testing.assert_allclose(here.hub_force[0], expected, atol=2e-3 * twice[0])  # shear of bent spans
    np.testing.assert_allclose(here.pulley_torque, 0.0, atol=1e-9)


def test_the_hubs_take_the_power_that_contact_loses(seen: tuple[float, Observations]) -> None:
    """At rest nothing; of a belt in balance that shifts as a whole, the springs of contact take no power."""
    speed, here = seen
    lost = float(here.friction_power.sum() + here.contact_damping_power.sum())
    assert lost == 0.0 if speed == 0.0 else lost > 1.0
    assert speed * here.hub_force[0, :, 0].sum() == pytest.approx(lost, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("arm", ["point", "rim"])
def test_friction_turns_a_pulley_with_the_arm_of_the_model(fine: Drive, arm: str) -> None:
    """A rim that runs through a belt at rest drives it by friction; both arms differ by the penetration."""
    system = drive_system(prepare(fine.replace(contact=fine.contact.replace(moment_arm=arm))))
    state = find_equilibrium(system, laid(system, fine.path)).state
    velocity = np.zeros_like(state.velocity)
    velocity[system.first_body + 1] = 50.0
    here = see(system, state.position, velocity)
    # power that the pulley gives is what friction takes, since the belt stands
    assert -50.0 * here.pulley_torque[0, 1] == pytest.approx(here.friction_power[0, 1], rel=1e-12)
    forces = system._replace(law=system.law._replace(arm_to_rim=not system.law.arm_to_rim))
    other = see(forces, state.position, velocity)
    ratio = float(here.pulley_torque[0, 1] / other.pulley_torque[0, 1])
    depth = install(fine).penetrations[1] / fine.radii[1]
    assert ratio - 1.0 == pytest.approx(depth if arm == "rim" else -depth, rel=0.05)  # the ends of the arc


def test_wrap_angles(fine: Drive, seen: tuple[float, Observations]) -> None:
    np.testing.assert_allclose(
        seen[1].wrap_angle[0], fine.path.wrap_angles, rtol=0.03
    )  # bending lifts the ends of the arcs


def test_belt_speed_is_measured_along_the_belt(seen: tuple[float, Observations]) -> None:
    np.testing.assert_allclose(
        seen[1].belt_speed[0], [seen[0], -seen[0]], rtol=1e-4
    )  # the spans are straight to 1e-2 rad


def test_kinetic_energy_of_a_translation(fine: Drive, seen: tuple[float, Observations]) -> None:
    mass = fine.belt.mass_per_length * fine.belt_length
    np.testing.assert_allclose(seen[1].kinetic_energy, 0.5 * mass * seen[0] ** 2, rtol=1e-12)


def test_points_know_their_pulley(fine: Drive, seen: tuple[float, Observations]) -> None:
    here = seen[1]
    position, touched = here.contact_position[0], here.contact_pulley[0]
    for number, pulley in enumerate(fine.pulleys):
        inside = np.linalg.norm(position - pulley.center, axis=1) <= pulley.radius
        np.testing.assert_array_equal(touched == number, inside)
    free = touched < 0
    assert not np.any(here.normal_force[0, free])
    assert not np.any(here.friction_force[0, free])
    assert not np.any(here.slip_velocity[0, free])


def test_spinning_pulleys_have_kinetic_energy(system: System, moving: State) -> None:
    still, turning = 0.0 * moving.velocity, 0.0 * moving.velocity
    turning[-1] = 5.0
    energies = [float(see(system, moving.position, velocity).kinetic_energy[0]) for velocity in (still, turning)]
    assert energies == pytest.approx([0.0, 0.5 * system.bodies.inertia[1] * 25.0])


@pytest.fixture(scope="module")
def fixed_points(make_drive: Callable[..., Drive]) -> System:
    return drive_system(prepare(make_drive("force_slope", "fixed")))


def test_forces_at_points_add_up_to_hub_forces_and_torques(fixed_points: System) -> None:
    """With fixed points the observed distributions are the very integrands of Eqs. 23 and 24."""
    system = fixed_points
    sunk = laid(system, Path(system.pulleys.center, system.pulleys.radius - 4e-4)).position
    seen = see(system, sunk, 0.5 * np.random.default_rng(2).normal(size=sunk.size))
    share = np.outer(system.length, system.contact.weights).ravel()
    assert np.any(seen.friction_force)
    for number, center in enumerate(system.pulleys.center):
        here = seen.contact_pulley[0] == number
        arm = seen.contact_position[0, here] - center
        normal = arm / np.linalg.norm(arm, axis=1)[:, None]
        tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        force = seen.normal_force[0, here, None] * normal + seen.friction_force[0, here, None] * tangent
        torque = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        np.testing.assert_allclose(seen.hub_force[0, number], -share[here] @ force, rtol=1e-10)
        assert seen.pulley_torque[0, number] == pytest.approx(-share[here] @ torque, rel=1e-10)


def test_states_observed_together_are_those_observed_alone(fixed_points: System) -> None:
    """A belt on its pulleys, and one that has left them; energies and tensions of the one that is shown."""
    system, random = fixed_points, np.random.default_rng(4)
    depths, shown = (-4e-4, 0.02), np.array([False, True])
    places = [laid(system, Path(system.pulleys.center, system.pulleys.radius + depth)).position for depth in depths]
    position = np.array([place + 1e-5 * random.normal(size=place.size) for place in places])
    velocity = 0.5 * random.normal(size=position.shape)
    forces = body_forces_at(system, np.zeros(2), position, velocity)
    together = observe_motion(system, position, velocity, forces, shown)
    alone = [see(system, position[k], velocity[k]) for k in range(2)]
    for name in ("span_tension", "belt_speed", "wrap_angle", "contact_pulley", "friction_force", "contact_position"):
        np.testing.assert_array_equal(getattr(together, name), [getattr(each, name)[0] for each in alone], name)
    assert not together.wrap_angle[1].any()
    for name in ("belt_tension", "kinetic_energy"):
        values = [getattr(each, name)[0] for each, kept in zip(alone, shown, strict=True) if kept]
        np.testing.assert_array_equal(getattr(together, name), values, name)


@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0])
def test_tension_along_elements_that_stretch_unevenly(drive: Drive, angle: float) -> None:
    """Straight elements with a stretch q: the force is EA (q^2 - 1) q / 2, and EA tau dq/dt by damping."""
    belt = drive.belt.replace(elements=3, stretch_damping_time=1e-3)
    system, along = belt_system(belt), np.array([np.cos(angle), np.sin(angle)])
    random = np.random.default_rng(2)
    places = system.length[0] * np.arange(4) * 1.02 + 1e-3 * random.normal(size=4)
    stretches, speeds, rates = 1.0 + 0.02 * random.normal(size=4), random.normal(size=4), random.normal(size=4)
    flat = np.zeros((4, 2))
    position = np.hstack([np.outer(places, along), np.outer(stretches, along), np.roll(along, 1) + flat])
    velocity = np.hstack([np.outer(speeds, along), np.outer(rates, along), flat])
    seen = see(system, position.ravel(), velocity.ravel())
    points, weights = gauss_points(belt.quadrature_points)
    for element, length in enumerate(system.length):
        ends = slice(element, element + 2)
        q, dq = (
            CubicHermiteSpline([0.0, length], value[ends], slope[ends]).derivative()(length * points)
            for value, slope in ((places, stretches), (speeds, rates))
        )
        force = belt.axial_stiffness * (0.5 * (q**2 - 1.0) * q + 1e-3 * dq)
        mean = weights @ force
        assert seen.belt_tension[0, element] == pytest.approx(mean, rel=1e-10)
        assert seen.tension_variation[0, element] == pytest.approx(np.sqrt(weights @ (force - mean) ** 2), rel=1e-8)

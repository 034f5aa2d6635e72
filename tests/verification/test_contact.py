"""Contact of whole belts (Eqs. 17-24): closed forms of straight and round belts, Newton's third law, capstan ratio.

The capstan ratio of a belt that slides on a pulley is T1 / T0 = exp(mu theta) (Euler and Eytelwein).
"""

from collections.abc import Callable
from math import asinh, pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Constant, Contact, Path, Pulley
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import NO_TANGENT, BodyForces, Motion, System
from beltdyn.system.build import belt_system
from beltdyn.system.observe import observe
from beltdyn.system.state import State, at_rest, laid
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers
from beltdyn.theory.creep import capstan_ratio

RADIUS = 0.1
STIFFNESS, DAMPING, FRICTION = 1e7, 50.0, 0.4
LAWS: dict[str, dict[str, Any]] = {
    "force_slope": {"friction_law": "force_slope", "creep_rate_factor": 1e3},
    "coefficient_slope": {"friction_law": "coefficient_slope", "creep_velocity": 0.2},
}


@pytest.fixture(scope="module", params=LAWS)
def contact(request: pytest.FixtureRequest) -> Contact:
    return Contact(
        stiffness=STIFFNESS,
        damping=DAMPING,
        friction=FRICTION,
        quadrature_points=8,
        moment_arm="point",
        **LAWS[request.param],
    )


def belt_of(length: float, elements: int, **changed: float) -> Belt:
    steel = {"width": 0.01, "thickness": 0.002, "density": 1e3, "youngs_modulus": 1e8, "poissons_ratio": 0.3}
    return Belt(length=length, elements=elements, **steel | changed)


def turning(speed: float, center: tuple[float, float] = (0.0, 0.0), name: str = "pulley") -> Pulley:
    return Pulley(name=name, center=center, radius=RADIUS, speed=Constant(value=speed))


def load(system: System, state: State) -> tuple[FloatArray, BodyForces]:
    """Residual of the nodes, shape (N, 6), and the forces on the pulleys."""
    equations = new_equations(system)
    motion = Motion(0.0, state.position, state.velocity, np.zeros_like(state.position))
    assemble(system, motion, no_multipliers(system), NO_TANGENT, equations)
    return equations.matrix.node_side, equations.forces


def moving(state: State, nodes: FloatArray, *speeds: float) -> State:
    """The state with velocities of its nodes, shape (N, 6), and of its pulleys."""
    return State(state.position, np.concatenate([nodes.ravel(), speeds]), state.acceleration)


class TestStraightBelt:
    """A straight belt through a pulley, 3 mm deep: with rho^2 = x^2 + h^2 the integrals are elementary."""

    HEIGHT = RADIUS - 0.003
    HALF = sqrt(RADIUS**2 - HEIGHT**2)
    LOG = asinh(HALF / HEIGHT)
    NORMAL = STIFFNESS * HEIGHT * (2 * RADIUS * LOG - 2 * HALF)
    """Integral of k_p (R - rho) h / rho."""
    SLIDING = STIFFNESS * FRICTION * (RADIUS * (HALF * RADIUS + HEIGHT**2 * LOG) - 2 * (HALF**3 / 3 + HEIGHT**2 * HALF))
    """Integral of mu k_p (R - rho) rho."""

    @pytest.fixture
    def forces(self, request: pytest.FixtureRequest, contact: Contact) -> BodyForces:
        belt = belt_of(0.3, 6)
        system = belt_system(belt, [turning(request.param)], contact)
        along = np.linspace(-0.16, 0.14, belt.given_elements + 1)
        ones, zeros = np.ones_like(along), np.zeros_like(along)
        state = at_rest(system, np.stack([along, self.HEIGHT * ones, ones, zeros, zeros, ones], axis=1))
        return load(system, moving(state, np.zeros((along.size, len(system.scale))), request.param))[1]

    @pytest.mark.parametrize("forces", [0.0], indirect=True)
    def test_normal_force(self, forces: BodyForces) -> None:
        np.testing.assert_allclose(
            forces.hub, [[0.0, -self.NORMAL]], atol=1e-9 * self.NORMAL
        )  # 8 Gauss points an element

    @pytest.mark.parametrize("forces", [-500.0, 500.0], ids=["clockwise", "counter-clockwise"], indirect=True)
    def test_torque_of_sliding(self, forces: BodyForces) -> None:
        np.testing.assert_allclose(abs(forces.moment), self.SLIDING, rtol=1e-9)
        assert forces.power[0] > 0.0  # the belt brakes, the driver drives


class TestRoundBelt:
    """A closed belt around one pulley, 1 mm inside everywhere: integrals are products with the unstretched length."""

    DEPTH, LENGTH, ELEMENTS = 1e-3, 0.6, 60
    MESH = 2e-4
    """The circle is missed by R phi^4 / 384 = 3e-8 m with phi = 6 degrees, 3e-5 of the depth."""

    @pytest.fixture
    def system(self, contact: Contact) -> System:
        return belt_system(belt_of(self.LENGTH, self.ELEMENTS), [turning(0.0)], contact, "shared_node")

    def forces(self, system: System, speed: float, sinking: float = 0.0, around: float = 0.0) -> BodyForces:
        """Loads for a pulley's speed and velocities of the belt towards and around the center."""
        angle = 2 * pi * np.arange(self.ELEMENTS) / self.ELEMENTS
        out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        forward = np.stack([-out[:, 1], out[:, 0]], axis=1)
        inside = RADIUS - self.DEPTH
        stretch = 2 * pi * inside / self.LENGTH
        state = at_rest(system, np.hstack([inside * out, stretch * forward, -out]))
        turn = 2 * pi / self.LENGTH
        velocity = np.hstack(
            [around * forward - sinking * out, -turn * (around * out + sinking * forward), -around / inside * forward]
        )
        return load(system, moving(state, velocity, speed))[1]

    def test_rest(self, system: System) -> None:
        forces = self.forces(system, 0.0)
        np.testing.assert_allclose(forces.hub, 0.0, atol=1e-9)  # rounding
        assert forces.moment[0] == pytest.approx(0.0, abs=1e-12)
        assert forces.stored[0] == pytest.approx(STIFFNESS * self.DEPTH**2 / 2 * self.LENGTH, rel=self.MESH)

    @pytest.mark.parametrize("speed", [-1.0, 1.0])
    def test_creep(self, system: System, contact: Contact, speed: float) -> None:
        normal = STIFFNESS * self.DEPTH
        slope = contact.creep_rate_factor or FRICTION * normal / (contact.creep_velocity or 1.0)
        torque = -slope * speed * RADIUS * (RADIUS - self.DEPTH) * self.LENGTH
        forces = self.forces(system, speed)
        assert forces.moment[0] == pytest.approx(torque, rel=self.MESH)
        assert forces.shaft[0] == pytest.approx(-torque, rel=self.MESH)
        assert forces.power[0] == pytest.approx(forces.power[2], rel=1e-12)  # what the driver gives is lost in friction

    @pytest.mark.parametrize("speed", [-500.0, 500.0])
    def test_sliding(self, system: System, speed: float) -> None:
        torque = FRICTION * STIFFNESS * self.DEPTH * (RADIUS - self.DEPTH) * self.LENGTH
        assert self.forces(system, speed).moment[0] == pytest.approx(-np.sign(speed) * torque, rel=self.MESH)

    def test_a_belt_that_turns_with_the_rim_feels_no_friction(self, system: System) -> None:
        forces = self.forces(system, 3.0, around=3.0 * RADIUS)
        sliding = FRICTION * STIFFNESS * self.DEPTH * RADIUS * self.LENGTH
        assert forces.moment[0] == pytest.approx(0.0, abs=1e-6 * sliding)

    def test_damping(self, system: System) -> None:
        sinking = 2.0
        forces = self.forces(system, 0.0, sinking=sinking)
        assert forces.power[3] == pytest.approx(
            DAMPING * sinking**2 * self.LENGTH, rel=1e-5
        )  # the velocity is interpolated


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 2e-3), st.floats(0.0, 2.0))
@pytest.mark.parametrize("integration", ["zone", "fixed"])
def test_belt_and_pulleys_act_on_each_other(
    contact: Contact, integration: str, seed: int, shake: float, speed: float
) -> None:
    """Force and moment of contact on the belt, as virtual work of rigid motions, against those on the pulleys."""
    random = np.random.default_rng(seed)
    centers = [(-0.2, 0.05), (0.2, -0.05)]
    pulleys = [turning(0.0, center, name) for name, center in zip("ab", centers, strict=True)]
    belt = belt_of(1.44, 12)
    system = belt_system(belt, pulleys, contact.model_copy(update={"integration": integration}), "shared_node")
    alone = belt_system(belt, closure="shared_node")
    state = laid(system, Path(np.array(centers), np.full(2, RADIUS - 1e-3)))
    nodes = state.nodes(system) + shake * random.normal(size=(12, len(system.scale)))
    motion = speed * random.normal(size=(12, len(system.scale)))
    state = moving(at_rest(system, nodes), motion, *(10.0 * speed * random.normal(size=2)))
    with_contact, on_pulleys = load(system, state)
    without, _ = load(alone, moving(at_rest(alone, nodes), motion))
    force = without - with_contact
    size = np.abs(force).sum() + 1.0
    rounding = 1e-10 * size
    np.testing.assert_allclose(force[:, :2].sum(axis=0), -on_pulleys.hub.sum(axis=0), atol=rounding)
    pairs, forces = nodes.reshape(12, 3, 2), force.reshape(12, 3, 2)
    moment = np.sum(pairs[..., 0] * forces[..., 1] - pairs[..., 1] * forces[..., 0])
    arms = np.array(centers)
    reaction = on_pulleys.moment.sum()
    reaction += np.sum(arms[:, 0] * on_pulleys.hub[:, 1] - arms[:, 1] * on_pulleys.hub[:, 0])
    assert moment == pytest.approx(-reaction, abs=rounding)


def over_the_top(angle: float, span: float, element: float) -> tuple[float, FloatArray]:
    """Length and nodes of an unstretched belt: a span, an arc over the top of the pulley from right to left, a span."""
    length = 2 * span + RADIUS * angle
    along = np.linspace(-0.5 * length, 0.5 * length, round(length / element) + 1)
    turn = np.clip(along / RADIUS, -0.5 * angle, 0.5 * angle)
    out = np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    forward = np.stack([-out[:, 1], out[:, 0]], axis=1)
    return length, np.hstack([RADIUS * out + (along - RADIUS * turn)[:, None] * forward, forward, -out])


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.6])
@pytest.mark.parametrize("angle", [pi / 3, pi / 2, pi], ids=["60 degrees", "90 degrees", "180 degrees"])
@pytest.mark.parametrize("sense", [1.0, -1.0], ids=["counter-clockwise", "clockwise"])
def test_capstan_ratio(
    contact: Contact,
    measured: Callable[..., None],
    curve: Callable[..., None],
    friction: float,
    angle: float,
    sense: float,
) -> None:
    """A belt is held at one end and pulled with 20 N at the other, over a pulley that slides below it at 10 m/s."""
    length, nodes = over_the_top(angle, span=0.05, element=0.01)
    belt = belt_of(length, len(nodes) - 1, bending_factor=1e-3)
    law = contact.model_copy(update={"friction": friction})
    system = belt_system(
        belt, [turning(sense * 100.0)], law, fixed=[(0, 0), (0, 1)], forces=[(-1, tuple(20.0 * nodes[-1, 2:4]))]
    )
    start = moving(at_rest(system, nodes), 0.0 * nodes, sense * 100.0)
    state = find_equilibrium(system, start).state
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    held, pulled = seen.belt_tension[0, [0, -1]]
    directions = np.arctan2(*state.nodes(system)[[0, -1], 3:1:-1].T)
    turned = (directions[1] - directions[0]) % (2 * pi)
    expected = capstan_ratio(friction, turned) ** sense
    measured(ratio=held / pulled, error=held / pulled / expected - 1.0)
    if contact.friction_law == "force_slope":
        place, label = np.degrees(turned), f"μ = {sense * friction:+g}"
        curve("capstan/ratio", np.linspace(0.0, place), expected ** np.linspace(0.0, 1.0), "theory", "k-")
        curve("capstan/ratio", [place], [held / pulled], label, "o")
        curve("capstan/error", [place], [abs(held / pulled / expected - 1.0)], label)
    assert pulled == pytest.approx(20.0, rel=1e-5)
    assert turned == pytest.approx(angle, rel=2e-3)  # the belt sinks in and its spans turn
    assert held / pulled == pytest.approx(expected, rel=1e-3)  # 1 % asked; penetration 2e-4 m of 0.1 m

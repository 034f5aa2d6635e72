"""The ends of a web line in the equations: lengths by the content, exact tangent of the tensions, power of the web."""

import numpy as np
import pytest

from beltdyn.kernel import interpreted
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.state.newton import steady_work
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import NO_TANGENT, TORQUE_WORK, Motion, System
from beltdyn.system.body_forces import new_body_forces
from beltdyn.system.build import staying_system
from beltdyn.system.state import State
from beltdyn.system.web import change_content, content, hold_web, push_web, rebased, set_content, way_of_content

ENTERS, LEAVES = 100.0, 150.0


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    """A line with gravity over one roller."""
    return prepare(
        Drive(
            belt={
                "axial_stiffness": 2e4,
                "bending_stiffness": 1e-4,
                "mass_per_length": 0.05,
                "thickness": 1e-4,
                "width": 0.2,
            },
            unwinder={"point": [0.0, 0.3], "tension": ENTERS},
            pulley=[{"name": "roller", "center": [0.5, 0.0], "radius": 0.05, "speed": 40.0}],
            winder={"point": [1.0, 0.3], "tension": LEAVES},
            contact={"friction": 0.4},
            simulation={"duration": 1.0},
            gravity=[0.0, -9.81],
        )
    )


@pytest.fixture
def system(prepared: Prepared) -> System:
    return staying_system(prepared, prepared.equal_lengths(12))


@pytest.fixture
def state(prepared: Prepared, system: System) -> State:
    return laid_state(prepared.laid, system, np.zeros(0))


def test_a_content_is_a_belt_of_another_length(prepared: Prepared, system: System) -> None:
    longer = prepared.with_length(1.003 * prepared.belt_length)
    other = staying_system(longer, longer.equal_lengths(12))
    interpreted(set_content)(system.carriage, system, 1.003)
    assert content(system).tolist() == [1.003]
    for name in ("length", "control", "mass"):
        np.testing.assert_allclose(getattr(system, name), getattr(other, name), rtol=1e-12, err_msg=name)
    for name in ("derivative", "inertia"):
        own, expected = getattr(system.frame, name), getattr(other.frame, name)
        np.testing.assert_allclose(own, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max(), err_msg=name)
    np.testing.assert_allclose(system.supports.force, other.supports.force, rtol=1e-12, atol=1e-15)
    assert content(rebased(system)).tolist() == [1.0]


def test_a_step_changes_the_content_by_the_last_unknown_but_one(system: System) -> None:
    border, before = np.array([9.0, 2e-3, 7.0]), system.length.copy()
    interpreted(change_content)(system.carriage, system, -0.5, border)
    assert content(system) == pytest.approx([0.999], rel=1e-12)
    np.testing.assert_allclose(system.length, 0.999 * before, rtol=1e-12)
    assert interpreted(way_of_content)(system.carriage, border) == pytest.approx(2e-3 * before.sum(), rel=1e-12)


def test_tensions_at_the_ends_are_equations_with_their_tangent(system: System, state: State) -> None:
    dof, law = len(system.scale), system.element.section.stretch

    def held(wanted: bool = False) -> tuple[np.ndarray, np.ndarray]:
        equations = steady_work(system).equations
        interpreted(hold_web)(system.carriage, system, state.at(0.0), False, wanted, equations)
        return equations.matrix.border_side[-2:], equations.matrix.row[:, -2:]

    laid = float(law.tension(np.hypot(*state.position[2:4])))
    side, row = held(wanted=True)
    assert side * law.stiffness == pytest.approx([laid - ENTERS, laid - LEAVES], rel=1e-9)
    for end, node in enumerate((0, system.nodes - 1)):
        for axis in range(2):
            at, step = dof * node + 2 + axis, 1e-6
            state.position[at] += step
            above = held()[0][end]
            state.position[at] -= 2.0 * step
            below = held()[0][end]
            state.position[at] += step
            assert row[node, end, 2 + axis] == pytest.approx((above - below) / (2.0 * step), rel=1e-6, abs=1e-8)


def test_a_web_at_rest_keeps_its_content(system: System, state: State) -> None:
    equations = steady_work(system).equations
    interpreted(hold_web)(system.carriage, system, state.at(0.0), True, True, equations)
    assert equations.matrix.border_side[-2:].tolist() == [0.0, 0.0]
    assert np.diag(equations.matrix.corner)[-2:].tolist() == [1.0, 1.0]


def test_power_comes_in_and_goes_out_with_the_web(system: System, state: State) -> None:
    """N c g - W c - rho A c^3 g^2 / 2 at the winder, the same with the other sign at the unwinder."""
    speed, stretch = 2.0, 1.01
    system.frame.speed[0] = speed
    last = state.position[: system.first_body][-len(system.scale) :]
    last[2:4] *= stretch / np.hypot(*last[2:4])
    forces, motion = new_body_forces(system), state.at(0.0)
    assert isinstance(motion, Motion)
    interpreted(push_web)(system.carriage, system, motion, NO_TANGENT, False, np.zeros((0, 0)), forces)
    law, mass = system.element.section.stretch, system.element.section.mass

    def passing(g: float) -> float:
        steps = np.linspace(1.0, g, 2001)
        energy = float(np.trapezoid(law.tension(steps), steps))
        return speed * (float(law.tension(g)) * g - energy - 0.5 * mass * speed**2 * g**2)

    expected = passing(stretch) - passing(float(np.hypot(*state.position[2:4])))
    assert forces.power[TORQUE_WORK] == pytest.approx(expected, rel=1e-6)

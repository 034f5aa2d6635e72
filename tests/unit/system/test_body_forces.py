"""The motion of prescribed shafts in a state."""

from importlib.resources import files

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import Drive, Pulley, example, prepare
from beltdyn.system.arrays import NO_TANGENT, Motion, TangentFactors
from beltdyn.system.body_forces import (
    BodyForcesScratch,
    add_machines,
    body_forces_history,
    fill_body_forces,
    new_body_forces,
    prescribe,
)
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.state import laid, straight

EXAMPLES = sorted(path.name[:-5] for path in (files("beltdyn") / "examples").iterdir() if path.name.endswith(".toml"))
QUICK = ("two_pulley",)
"""Examples that need no kernels of their own."""

SIGNALING_NAN = np.uint64(0x7FF0000000000001)
"""Bits that even adding zero changes."""


def test_prescribe_writes_prescribed_pulleys_only(drive: Drive) -> None:
    system = belt_system(drive.belt, drive.pulleys, drive.contact, "shared_node")
    position, velocity, acceleration = np.full((3, 6 * system.nodes + 2), 7.0)
    prescribe(system, Motion(0.325, position, velocity, acceleration))
    assert position[-2:] == pytest.approx([6.0 * 0.275 / 2.0, 7.0])
    assert velocity[-2:] == pytest.approx([6.0, 7.0])
    assert acceleration[-2:] == pytest.approx([12.0 / 0.55, 7.0])
    assert np.all(position[:-2] == 7.0)
    assert np.all(velocity[:-2] == 7.0)
    assert np.all(acceleration[:-2] == 7.0)


def test_tangent_of_a_motor_with_a_controller(drive: Drive) -> None:
    """Of its shaft and of the integral part of its torque, which follows the error of its speed, by differences."""
    servo = {"kind": "servo_motor", "speed": {"kind": "constant", "value": 100.0}, "proportional_gain": 2.0}
    servo |= {"integral_time": 0.05, "torque_limit": 30.0, "lag": 2e-3}
    pulley = Pulley(name="far", center=(0.0, 50.0), radius=0.1, inertia=0.4, load=[servo])
    system = belt_system(drive.belt.replace(elements=3), [pulley], drive.contact)
    assert system.bodies.unknown.tolist() == [0, 1]
    rest, random, factors = straight(system), np.random.default_rng(2), TangentFactors(1.0, 30.0, 0.0)
    position, velocity = rest.position.copy(), rest.velocity.copy()
    velocity[-2:], position[-2:] = (97.0, 5.0), (0.3, 8.0)

    def forces(step: FloatArray, wanted: TangentFactors = NO_TANGENT) -> tuple[FloatArray, FloatArray]:
        places, rates = position.copy(), velocity.copy()
        places[-2:] += factors.by_position * step
        rates[-2:] += factors.by_velocity * step
        corner, found = np.zeros((2, 2)), new_body_forces(system)
        motion = Motion(0.0, places, rates, np.zeros_like(places))
        interpreted(add_machines)(system, motion, wanted, corner, found)
        return corner, found.force.copy()

    step = random.normal(size=2)
    difference = (forces(1e-6 * step)[1] - forces(-1e-6 * step)[1]) / 2e-6
    np.testing.assert_allclose(forces(np.zeros(2), factors)[0] @ step, -difference, rtol=1e-6)


@pytest.mark.parametrize(
    "name", [one if one in QUICK else pytest.param(one, marks=pytest.mark.slow) for one in EXAMPLES]
)
def test_forces_alone_touch_no_tangent(name: str) -> None:
    """Whatever machines a drive has: who asks for forces has no tangent, and its array may be empty."""
    prepared = prepare(example(name))
    system = drive_system(prepared)
    state, size = laid(system, prepared.path), system.bodies.size
    corner = np.full((size, size), SIGNALING_NAN).view(np.float64)
    scratch = BodyForcesScratch(
        np.zeros_like(state.position), element_workspace(system), corner, new_body_forces(system)
    )
    moving = np.ones_like(state.velocity)
    fill_body_forces(
        system, np.array([0.01]), state.position[None], moving[None], scratch, body_forces_history(system, 1)
    )
    assert np.all(corner.view(np.uint64) == SIGNALING_NAN)

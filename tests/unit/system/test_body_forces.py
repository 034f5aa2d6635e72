"""The motion of prescribed shafts in a state."""

from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import Drive, example, prepare
from beltdyn.system.arrays import Motion
from beltdyn.system.body_forces import (
    BodyForcesScratch,
    body_forces_history,
    fill_body_forces,
    new_body_forces,
    prescribe,
)
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.state import laid

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

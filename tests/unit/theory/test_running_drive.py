"""The boundary-value problem of a running drive: balance of its solution, refusal of impossible loads."""

from dataclasses import replace

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.stretch import Green
from beltdyn.theory.running_drive import RunningDrive, run_steadily

DRIVE = RunningDrive(
    length=1.2443,
    law=Green(1e5),
    bending=8e-4,
    shear=30.0,
    mass=0.1,
    rotary_inertia=8e-7,
    distance=0.38,
    radii=(0.08, 0.08),
    stiffness=1e7,
    friction=1.2,
    creep_rate_factor=1e4,
    speed=100.0,
    load=20.0,
)


def test_balance_of_torque_and_tension() -> None:
    belt = run_steadily(DRIVE)
    step = np.diff(belt.coordinate)
    arms = np.hypot(belt.position[0] - DRIVE.distance, belt.position[1])
    moment = -arms * belt.friction_force[1]
    assert np.sum(0.5 * step * (moment[1:] + moment[:-1])) == pytest.approx(DRIVE.load, rel=1e-5)
    assert belt.driven_speed < DRIVE.speed
    half = len(belt.tension) // 2
    tight, slack = belt.tension[half], belt.tension[0]
    assert (tight - slack) * (0.08 - 0.002) == pytest.approx(DRIVE.load, rel=0.02)  # the depth of 2 mm is not uniform


def test_too_much_load() -> None:
    with pytest.raises(ConvergenceError, match="load"):
        run_steadily(replace(DRIVE, load=1e4))

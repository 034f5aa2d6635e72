"""A run-up of a drive."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.solve.sweep import run_up, sweep


def test_the_speed_rises_linearly_after_a_lead(drive: Drive) -> None:
    up = run_up(drive, "driver", 70.0, 600.0, 5.0)
    profile = up.pulleys[0].speed
    assert profile is not None
    np.testing.assert_allclose(profile.at([0.0, 0.25, 0.5, 3.0, 5.5]), [0.0, 35.0, 70.0, 335.0, 600.0])
    assert up.simulation.duration == 5.5
    assert (up.pulleys[1], up.belt, up.contact) == (drive.pulleys[1], drive.belt, drive.contact)


def test_a_drive_without_a_prescribed_speed_cannot_be_swept(drive: Drive) -> None:
    free = drive.replace(pulley=[one.replace(speed=None, torque=None, inertia=0.1) for one in drive.pulleys])
    with pytest.raises(ModelError, match="Give it a speed in the drive file"):
        run_up(free, "driver", 1.0, 2.0, 1.0)


@pytest.mark.parametrize(("start", "end"), [("600 rpm", "1200 rpm"), (20.0 * np.pi, 40.0 * np.pi)])
def test_a_sweep_is_a_run_that_names_its_pulley(drive: Drive, start: float | str, end: float | str) -> None:
    """Numbers are in SI units, texts have theirs."""
    run = sweep(drive, pulley="driver", from_=start, to=end, duration="10 ms")
    assert run.kind == "run"
    assert run.dataset.attrs["swept_pulley"] == "driver"
    assert float(run.dataset.pulley_speed.sel(pulley="driver")[-1]) == pytest.approx(40.0 * np.pi)
    assert float(run.dataset.time[-1]) == pytest.approx(0.011)

"""A speed measured over the angle of a crank, as harmonics over the angle of its mean."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from beltdyn.errors import ModelError
from beltdyn.machines.profiles.functions import prescribed_motion
from beltdyn.machines.profiles.harmonic import CrankSpeed
from beltdyn.model import Pulley
from beltdyn.system.build_machines import machine_arrays

PLACE: dict[str, Any] = {"name": "crank", "center": (0, 0), "radius": 0.1}
ANGLES = np.linspace(0.0, 4 * np.pi, 180, endpoint=False)


def measured(angle: Any) -> Any:
    """A four-stroke engine of uneven cylinders, rad/s: 12 % up and down."""
    return 80.0 + 8.0 * np.sin(2 * angle) + 2.0 * np.cos(angle / 2 + 0.3) + np.sin(4 * angle)


CRANK: dict[str, Any] = {"angles": ANGLES.tolist(), "speeds": measured(ANGLES).tolist(), "cycle": 4 * np.pi}


def test_at_the_measured_mean_it_moves_as_it_was_measured() -> None:
    """The angle solves d theta / dt = w(theta), whose mean over time is below that over the angle."""
    times = np.linspace(0.0, 0.5, 101)
    exact = solve_ivp(lambda _, angle: measured(angle), (0, 0.5), [0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]
    fine = np.linspace(0.0, 4 * np.pi, 100_001)
    mean = 4 * np.pi / np.trapezoid(1 / measured(fine), fine)
    pulley = Pulley(**PLACE, speed={"kind": "constant", "value": mean}, harmonics=CRANK)
    profiles = machine_arrays([pulley]).profiles
    angle, speed, _ = np.transpose([prescribed_motion(profiles, 0, time) for time in times])
    np.testing.assert_allclose(angle, exact, atol=2e-3)  # harmonics below a thousandth of 10 % are left out
    np.testing.assert_allclose(speed, measured(exact), rtol=1e-3)


def test_small_waves_are_those_of_the_angle() -> None:
    table = CrankSpeed(
        angles=ANGLES.tolist(), speeds=(100.0 + 0.01 * np.cos(2 * ANGLES - 0.4)).tolist(), cycle=4 * np.pi
    )
    (wave,) = table.harmonics()
    assert (wave.order, wave.amplitude, wave.phase) == pytest.approx((2.0, 1e-4, -0.4), rel=2e-4)


def test_a_steady_crank_has_no_harmonics() -> None:
    assert CrankSpeed(angles=(0, 1, 2, 3), speeds=(5.0,) * 4).harmonics() == ()


def test_a_closed_table_and_an_open_one_have_the_same_harmonics() -> None:
    closed = {"angles": [*ANGLES.tolist(), 4 * np.pi], "speeds": [*CRANK["speeds"], CRANK["speeds"][0]]}
    there, here = (CrankSpeed(**CRANK | table).harmonics() for table in (closed, {}))
    assert [(wave.order, wave.amplitude, wave.phase) for wave in there] == [
        pytest.approx((wave.order, wave.amplitude, wave.phase), rel=1e-9) for wave in here
    ]


def test_a_file_in_degrees_and_rpm(tmp_path: Path) -> None:
    rows = [f"{np.degrees(angle)},{speed * 30 / np.pi}" for angle, speed in zip(ANGLES, measured(ANGLES), strict=True)]
    (tmp_path / "crank.csv").write_text("deg,rpm\n" + "\n".join(rows))
    given = {"file": "crank.csv", "units": ["deg", "rpm"], "cycle": "720 deg"}
    pulley = PLACE | {"speed": {"kind": "constant", "value": 1.0}}
    read = Pulley.model_validate(pulley | {"harmonics": given}, context={"base": tmp_path})
    for one, other in zip(read.harmonics, Pulley(**pulley, harmonics=CRANK).harmonics, strict=True):
        assert (one.order, one.amplitude, one.phase) == pytest.approx((other.order, other.amplitude, other.phase))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"speeds": (1.0, 2.0, -1.0, 2.0)}, "speeds range from -1 to 2 rad/s: a crank that stops or"),
        ({"speeds": (1.0, 2.0)}, "needs at least 4 entries"),
        ({"cycle": 2.0}, "angles span 3 rad, more than cycle = 2 rad. Give one cycle"),
        ({"angles": (0.0, 2.0, 1.0, 3.0)}, "angles must increase, but 1 follows 2"),
    ],
)
def test_errors(changes: dict[str, Any], sentence: str) -> None:
    table = {"angles": (0.0, 1.0, 2.0, 3.0), "speeds": (5.0, 6.0, 7.0, 6.0)}
    with pytest.raises(ModelError) as caught:
        CrankSpeed(**table | changes)
    assert sentence in str(caught.value)
    with pytest.raises(ModelError, match="harmonics"):
        Pulley(**PLACE, speed={"kind": "constant", "value": 1.0}, harmonics=table | changes)

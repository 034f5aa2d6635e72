"""An alternator behind a one-way clutch, when the crank slows down faster than it: it overruns, and is driven again.

While it overruns nothing but its own load and the drag of the clutch act on it,

    I domega/dt = -l omega - M_d    =>    omega + M_d / l = (omega_0 + M_d / l) exp(-l (t - t_0) / I).
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.model import Drive

Make = Callable[..., Drive]
Measured = Callable[..., None]

INERTIA, LOAD, DRAG, LOCKING = 0.004, 0.02, 0.05, 50.0
SPEED, RADII = 60.0, (0.08, 0.03)
RATIO = RADII[0] / RADII[1]
CRANK = {"kind": "table", "times": [0.0, 0.05, 0.1, 0.14, 0.2], "values": [0.0, SPEED, SPEED, 0.3 * SPEED, SPEED]}


@pytest.fixture(
    scope="module", params=[1.0, pytest.param(-1.0, marks=pytest.mark.slow)], ids=["counter-clockwise", "clockwise"]
)
def run(request: pytest.FixtureRequest, make: Make) -> xr.Dataset:
    """Brought to speed by 0.05 s, slowed from 0.1 s to 0.14 s, and brought to speed again by 0.2 s."""
    sense = request.param
    clutch: dict[str, Any] = {
        "kind": "one_way_clutch", "locking_damping": LOCKING, "drag_torque": DRAG, "inertia": INERTIA,
        "drives": "forward" if sense > 0 else "backward",
    }  # fmt: skip
    crank = CRANK | {"values": [sense * value for value in CRANK["values"]]}
    drive = make(
        [
            {"name": "crank", "center": (0.0, 0.0), "radius": RADII[0], "speed": crank},
            {
                "name": "alternator", "center": (0.3, 0.0), "radius": RADII[1], "inertia": 3e-4, "hub": [clutch],
                "load": [{"kind": "resistance", "linear": LOAD}],
            },
        ],
        belt={"installed_tension": 400.0, "elements": 50},
        simulation={"duration": 0.22, "output_interval": 2.5e-4, "rtol": 1e-4},
    )  # fmt: skip
    dataset = simulate(drive).dataset
    dataset["sense"] = sense
    return dataset


@pytest.mark.slow
def test_overruns_as_its_load_lets_it(run: xr.Dataset, measured: Measured) -> None:
    sense, time = float(run.sense), run.time.values
    rim, shaft = sense * run.pulley_speed.values[:, 1], sense * run.shaft_speed.values[:, 1]
    ahead = shaft > rim + 1.0
    first = int(np.argmax(ahead & (time > 0.1)))
    inside = np.arange(first, first + int(np.argmin(ahead[first:])))
    held = DRAG / LOAD
    expected = (shaft[first] + held) * np.exp(-LOAD * (time[inside] - time[first]) / INERTIA) - held
    error = float(np.abs(shaft[inside] / expected - 1).max())
    measured(begins=time[first], ends=time[inside[-1]], ahead=(shaft - rim).max(), error=error)
    assert (shaft - rim)[inside].max() > 20.0
    assert time[inside[-1]] - time[first] > 0.03
    np.testing.assert_allclose(shaft[inside], expected, rtol=1e-4)


@pytest.mark.slow
def test_drives_again_and_never_backwards(run: xr.Dataset, measured: Measured) -> None:
    """The torque through the clutch, from the motion of the inertia behind it by differences over 0.5 ms."""
    sense, time = float(run.sense), run.time.values
    shaft = sense * run.shaft_speed.values[:, 1]
    through = INERTIA * np.gradient(shaft, time) + LOAD * shaft
    rim = sense * run.pulley_speed.values[:, 1]
    driving = (time > 0.18) & (time < 0.199)
    slip = LOCKING * float(np.mean((rim - shaft)[driving]))
    again = float(through[driving].mean())
    measured(least=through[1:-1].min(), again=again, by_slip=slip, largest=through.max())
    assert np.all(through[1:-1] > -DRAG - 1e-3 * again)
    assert again > 50 * DRAG
    assert again == pytest.approx(slip, rel=0.01)

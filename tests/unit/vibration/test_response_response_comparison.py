"""Amplitudes beside a response: orders of a run whose orders are known, and measured ones."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.vibration.excitation import LOAD, SHAFT, SPEED, Excitation
from beltdyn.vibration.response import Place, measured_amplitudes, run_up_amplitudes
from validation.published.cases import loaded_two_pulley

SPEEDS = np.array([70.0, 100.0, 150.0])
NAMES = ["driver", "driven"]
SPANS = ["driver-driven", "driven-driver"]
RATIO = 0.5
"""Speed of the driven pulley over that of the driver."""
PLACE = Place(
    SPEEDS,
    0,
    [Excitation("two", SPEED, 2.0, SHAFT, 0), Excitation("three", LOAD, 3.0, SHAFT, 1)],
    {"pulley": NAMES, "span": SPANS, "tensioner": []},
)


@pytest.fixture(scope="module")
def run() -> bd.Run:
    """A rise from 40 to 140 rad/s; tensions have order 2 of the driver and order 3 of the driven pulley."""
    time = np.linspace(0.0, 10.0, 20001)
    speed, angle = 40.0 + 10.0 * time, 40.0 * time + 5.0 * time**2
    tension = 300.0 + 7.0 * np.cos(2.0 * angle) + 4.0 * np.cos(3.0 * RATIO * angle)
    of_pulleys, of_spans = ("time", "pulley"), ("time", "span")
    data = {
        "shaft_speed": (of_pulleys, np.stack([speed, -RATIO * speed], axis=1), {"units": "rad/s", "long_name": "w"}),
        "shaft_angle": (of_pulleys, np.stack([angle, -RATIO * angle], axis=1)),
        "span_tension": (of_spans, np.stack([tension, 2.0 * tension], axis=1), {"units": "N", "long_name": "T"}),
        "hub_force": (
            (*of_pulleys, "axis"),
            np.stack([np.stack([3.0 * tension, 4.0 * tension], axis=1)] * 2, axis=1),
            {"units": "N", "long_name": "F"},
        ),
    }
    dataset = xr.Dataset(data, {"time": time, "pulley": NAMES, "span": SPANS}, {"status": "completed"})
    return bd.Run(dataset, loaded_two_pulley())


def test_orders_of_a_run_up(run: bd.Run) -> None:
    found = run_up_amplitudes(run, PLACE)
    assert set(found) == {f"run_up_{name}_amplitude" for name in ("span_tension", "shaft_speed", "hub_load")}
    values = np.asarray(found["run_up_span_tension_amplitude"][1])
    np.testing.assert_allclose(values[:2, 0], [[7.0, 14.0]] * 2, rtol=0.01)
    np.testing.assert_allclose(values[:2, 1], [[4.0, 8.0]] * 2, rtol=0.01)
    assert np.isnan(values[2]).all()
    np.testing.assert_allclose(np.asarray(found["run_up_hub_load_amplitude"][1])[1, 0], 35.0, rtol=0.01)


def test_a_run_of_another_drive(run: bd.Run) -> None:
    with pytest.raises(ModelError, match="the run given by compare has the pulleys driver, driven"):
        run_up_amplitudes(run, PLACE._replace(labels={**PLACE.labels, "pulley": ["a", "b"]}))


def test_measured(tmp_path: Path) -> None:
    path = tmp_path / "measured.csv"
    path.write_text(
        "speed [rad/s], span_tension driven-driver order 2 [kN]\n0, 0\n100, 0.5\n120, 0\n", encoding="utf-8"
    )
    (found,) = measured_amplitudes(path, PLACE).items()
    assert found[0] == "measured_span_tension_amplitude"
    values = np.asarray(found[1][1])
    np.testing.assert_allclose(values[:, 0, 1], [350.0, 500.0, np.nan])
    assert np.isnan(values[:, 1]).all()
    assert np.isnan(values[:, :, 0]).all()


@pytest.mark.parametrize(
    ("heading", "said"),
    [
        ("tension", 'the heading "tension" must be of the form'),
        ("span_tensoin driven-driver order 2", "span_tensoin is not a result of a response"),
        ("span_tension driven order 2", "driven is not in this drive"),
        ("span_tension driven-driver order 3", "order 3 does not excite the drive. Orders of this pulley: 2"),
    ],
)
def test_headings_that_are_wrong(tmp_path: Path, heading: str, said: str) -> None:
    path = tmp_path / "measured.csv"
    path.write_text(f"speed [rpm], {heading} [N]\n0, 0\n100, 0.5\n", encoding="utf-8")
    with pytest.raises(ModelError, match=said):
        measured_amplitudes(path, PLACE)


def test_speeds_that_do_not_rise(tmp_path: Path) -> None:
    path = tmp_path / "measured.csv"
    path.write_text("speed [rpm], span_tension driven-driver order 2 [N]\n10, 0\n10, 0.5\n", encoding="utf-8")
    with pytest.raises(ModelError, match="ascending"):
        measured_amplitudes(path, PLACE)

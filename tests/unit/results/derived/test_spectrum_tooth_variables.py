"""Transmission error and order spectra."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import prepare
from beltdyn.results import Run, derived
from tests.unit.model.test_toothing import drive

TIME = np.linspace(0.0, 0.4, 4001)
TURNED = 100.0 * TIME
RIPPLE = 3e-6 * np.sin(24 * TURNED)
"""Of the belt at the pitch line, m, at the meshing order of a pulley of 24 teeth."""


def run(given: bd.Drive) -> Run:
    """A run in which the driven pulley of 36 teeth is ahead by a ripple."""
    pitch_radius = 36 * 8e-3 / (2.0 * np.pi)
    angle = np.stack([TURNED, TURNED * 24 / 36 + RIPPLE / pitch_radius], axis=1)
    names = [pulley.name for pulley in given.pulleys]
    angles = xr.DataArray(angle, {"time": TIME, "pulley": names}, ("time", "pulley"))
    dataset = xr.Dataset({"pulley_angle": angles}).assign_coords(field_time=TIME[:1], filtered_time=TIME[:1])
    made: Any = SimpleNamespace(prepared=prepare(given), drive=given, dataset=dataset, require_output=lambda: None)
    return cast(Run, made)


def test_transmission_error_is_what_the_ratio_of_teeth_leaves() -> None:
    error = derived.transmission_error(run(drive()))
    assert error.attrs["units"] == "m"
    np.testing.assert_allclose(error.sel(pulley="driver"), 0.0, atol=1e-15)
    np.testing.assert_allclose(error.sel(pulley="driven"), RIPPLE, atol=1e-12)
    other = derived.transmission_error(run(drive()), "driven", start=0.1)
    np.testing.assert_allclose(other.sel(pulley="driver"), RIPPLE[1000] - RIPPLE[1000:], atol=1e-12)


def test_the_meshing_order_stands_out() -> None:
    made = run(drive())
    error = derived.transmission_error(made).sel(pulley="driven")
    found = derived.order_spectrum(error, made.dataset["pulley_angle"][:, 0], "boxcar")
    assert float(found.sel(order=24.0)) == pytest.approx(3e-6, rel=1e-3)
    others = found.where(abs(found["order"] - 24.0) > 0.5, drop=True)
    assert float(others.max()) < 3e-9  # of the splines
    assert found["order"].attrs["long_name"] == "Order"


def test_what_has_no_transmission_error() -> None:
    smooth = bd.Drive(
        belt={"profile": "flat-aramid", "width": 0.02, "length": 0.8},
        pulley=[
            {"name": n, "center": [x, 0.0], "radius": 0.04, "speed": 1.0} for n, x in (("driver", 0.0), ("b", 0.28))
        ],
        simulation={"duration": 1.0},
    )
    with pytest.raises(ModelError, match="the belt has no teeth"):
        derived.transmission_error(run(smooth))
    idler = {"name": "idler", "center": [0.14, 0.055], "radius": 0.02, "side": "outside", "inertia": 1e-4}
    given = drive().replace(pulley=[*drive().pulleys, idler])
    made = run(drive())
    made.prepared = prepare(given)
    made.drive = given  # type: ignore[misc]
    with pytest.raises(ModelError, match=r"idler has no teeth\. Choose a reference of driver, driven"):
        derived.transmission_error(made, "idler")


def test_orders_need_turns_one_way() -> None:
    made = run(drive())
    error = derived.transmission_error(made).sel(pulley="driven")
    angle = made.dataset["pulley_angle"][:, 0]
    with pytest.raises(ModelError, match="an order spectrum needs 2 or more"):
        derived.order_spectrum(error[:1000], angle[:1000])
    back = angle.copy(data=np.sin(20.0 * TIME) * 40.0)
    with pytest.raises(ModelError, match="without turning back"):
        derived.order_spectrum(error, back)

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn.model import Drive
from beltdyn.results import Run
from validation.paper.measures import lag, largest, ripple, ripple_frequency, rms, settled_mean

TIME = np.linspace(0.0, 1.0, 1001)


@pytest.fixture
def swinging(drive: Drive) -> Callable[..., Run]:
    """A run whose driven pulley lags by 0.5 rad/s in the ramp and swings about the driver's speed after it."""

    def make(frequency: float) -> Run:
        driver = 12.0 * np.clip((TIME - 0.05) / 0.55, 0.0, 1.0)
        swing = 0.4 * np.exp(-4.0 * (TIME - 0.6)) * np.cos(2.0 * np.pi * frequency * (TIME - 0.6))
        driven = driver + np.where(TIME < 0.6, -0.5, swing)
        speeds = np.stack([driver, driven], axis=1)
        return Run(xr.Dataset({"pulley_speed": (("time", "pulley"), speeds)}, {"time": TIME}), drive)

    return make


def test_ripple_frequency(swinging: Callable[..., Run]) -> None:
    """Linear interpolation between outputs of 1 ms finds a crossing of 8.5 Hz to far less than 0.1 ms."""
    assert ripple_frequency(swinging(8.5)) == pytest.approx(8.5, rel=1e-3)


def test_too_few_crossings_have_no_frequency(swinging: Callable[..., Run]) -> None:
    assert np.isnan(ripple_frequency(swinging(2.0)))


def test_ripple_begins_with_the_end_of_the_ramp(swinging: Callable[..., Run]) -> None:
    values = ripple(swinging(8.5))
    assert values.size == 401
    assert largest(values) == pytest.approx(0.4)


def test_lag_is_that_within_the_ramp(swinging: Callable[..., Run]) -> None:
    np.testing.assert_allclose(lag(swinging(8.5)), 0.5)


def test_settled_mean_is_that_of_the_end(swinging: Callable[..., Run]) -> None:
    assert settled_mean(swinging(8.5), "pulley_speed", 0) == pytest.approx(12.0)


def test_root_mean_square() -> None:
    assert rms(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5))

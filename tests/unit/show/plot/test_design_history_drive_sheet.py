"""Figures of a drive sheet."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import example


@pytest.mark.parametrize("power", ["5 kW", "100 W"])
def test_slip_safeties_are_in_the_picture_of_loaded_and_of_safe_drives(power: str) -> None:
    row = {"share": 1.0, "speed": "1500 rpm", "power": {"alternator": power}}
    found = bd.sheet(example("alternator_drive").replace(duty=[row]), points=3, light_load=0.5)
    ax = bd.plot.sheet_slip_safety(found)
    lines = {str(line.get_label()): np.asarray(line.get_ydata(), dtype=float) for line in ax.get_lines()}
    dataset, top = found.dataset, ax.get_ylim()[1]
    worst = str(dataset.pulley[int(np.nanargmin(np.fmin.reduce(dataset.least_slip_safety_over_speed.values)))].item())
    assert np.nanmin(dataset.least_slip_safety_over_speed.sel(pulley=worst)) < top
    np.testing.assert_allclose(lines[worst], dataset.slip_safety_over_speed.sel(pulley=worst))

"""Traction curves: where they begin and end, and what they are of."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.model import Drive, load
from beltdyn.points.traction import traction
from beltdyn.results import open_result
from beltdyn.show.sheet import Table, sheet
from beltdyn.state.steady import steady_state
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def loaded() -> Drive:
    drive = better(loaded_two_pulley())
    return drive.replace(contact=drive.contact.replace(friction=0.3))


@pytest.mark.slow
def test_from_nothing_past_gross_slip(loaded: Drive, tmp_path: Path) -> None:
    file = tmp_path / "traction.nc"
    found = traction(loaded, points=8, output=file).dataset
    xr.testing.assert_allclose(open_result(file).dataset[["torque", "elastic"]], found[["torque", "elastic"]])
    assert found.attrs["pulley"] == "driven"
    assert np.all(np.diff(found.torque) > -1e-6 * float(found.limit_torque))
    assert abs(float(found.torque[0])) < 0.1
    assert found.sliding_share[-1] > 0.99
    assert float(found.slip[-1]) == pytest.approx(1.2 * 0.164, rel=0.03)
    assert found.sliding_share[0] < 0.05
    assert float(found.limit_torque) == pytest.approx(float(found.torque[-1]), rel=1e-6)
    np.testing.assert_allclose(found.elastic + found.added + found.slid, found.slip, atol=1e-9)
    np.testing.assert_allclose(found.pulley_slip.sel(pulley="driven"), found.slip, atol=1e-9)


@pytest.mark.slow
def test_where_steps_of_the_slip_are_too_long_shorter_ones_are_taken() -> None:
    """The arc of the alternator slides on nine tenths, and that of the crank on seven: a step of 0.1 % is too long."""
    found = traction(
        load(str(files("beltdyn") / "examples" / "alternator_drive.toml")), slip="2.0..2.6 %", points=6
    ).dataset
    assert np.all(found.failure == "")
    assert np.all(np.diff(found.torque) > 0.0)
    assert found.sliding_share[-1] > 0.9


def test_which_pulley(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="pulley = 'driver' is the driver"):
        traction(loaded, pulley="driver")
    with pytest.raises(ModelError, match="points = 2 must be at least 3"):
        traction(loaded, points=2)


@pytest.mark.slow
def test_guides_that_stand_still_are_no_choice_and_have_no_slip() -> None:
    """The belt slides over them by nature, which is no slip to be judged."""
    drive = load(Path(__file__).parents[3] / "docs" / "tasks" / "handrail.toml")
    found = traction(drive, slip="0.02, 0.04 %").dataset
    assert found.attrs["pulley"] == "roller"
    assert found.largest_slip.isnull().values.tolist() == [False, False, True, True]
    rows = next(one for one in sheet(steady_state(drive)).parts if one.title.startswith("Pulleys"))
    assert isinstance(rows, Table)
    assert [row[5] for row in rows.rows[2:]] == ["–", "–"]

"""Wear of a belt that slips steadily is its power times the time."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.derived import wear_by_arc, wear_by_belt
from beltdyn.results.mechanics import cells

SINGLE = 1e-6
"""Rounding of the works of a hundred outputs."""

MakeRun = Callable[..., Run]
POWER = 40.0 * 0.025
"""W/m."""


@pytest.fixture
def steady(make_run: MakeRun, run: Run) -> Run:
    touched = run.dataset["contact_pulley"].values >= 0
    return make_run(friction_force=np.where(touched, -40.0, 0.0), slip_velocity=np.where(touched, 0.025, 0.0))


def test_wear_of_the_arc_is_even(steady: Run) -> None:
    """Over 1 s and a belt 0.3 % longer than its unstretched length; contact comes and goes by whole points."""
    wear = wear_by_arc(steady, start=0.0)
    inside = (wear["share"] > 0.1) & (wear["share"] < 0.9)
    stretch = steady.drive.path.length / steady.drive.belt_length
    values = wear.where(inside, drop=True).sum("share") / inside.sum()
    np.testing.assert_allclose(values, POWER / stretch, rtol=0.02)
    assert wear.attrs["units"] == "J/m"


def test_all_work_is_somewhere_on_the_arc_and_somewhere_on_the_belt(steady: Run) -> None:
    dataset, drive = steady.dataset, steady.drive
    cell = cells(dataset["belt_coordinate"].values, drive.belt_length)
    power = np.abs(dataset["friction_force"].values * dataset["slip_velocity"].values) @ cell
    work = np.trapezoid(power, dataset["time"])
    arc, belt = wear_by_arc(steady), wear_by_belt(steady)
    assert float((arc * arc["part_length"]).sum()) == pytest.approx(work, rel=SINGLE)
    assert float(belt.sum()) * drive.belt_length / belt.sizes["element"] == pytest.approx(work, rel=SINGLE)
    by_pulley = (arc * arc["part_length"]).sum("share")
    np.testing.assert_allclose(by_pulley, belt.sum("element") * drive.belt_length / belt.sizes["element"], rtol=SINGLE)


def test_nothing_outside_of_the_arc_wears(steady: Run) -> None:
    wear = wear_by_arc(steady)
    outside = (wear["share"] < -0.05) | (wear["share"] > 1.05)
    assert float(wear.where(outside, 0.0).max()) == 0.0
    assert float(wear.max()) > 0.0


def test_belt_wears_where_it_has_been_on_a_pulley(steady: Run) -> None:
    wear = wear_by_belt(steady)
    touched = (steady.dataset["contact_pulley"].values == 1).any(axis=0).reshape(-1, 5).any(axis=1)
    np.testing.assert_array_equal(wear.values[1] > 0.0, touched)


@pytest.mark.parametrize("wear", [wear_by_arc, wear_by_belt])
def test_work_is_done_between_two_outputs(steady: Run, wear: Callable[..., xr.DataArray]) -> None:
    """One tenth of a second holds a tenth of the work of a second; an instant holds none."""
    tenth, whole = (float(wear(steady, start=0.2, end=end).sum()) for end in (0.3, 1.0))
    assert tenth == pytest.approx(whole / 8.0, rel=0.03)  # contact comes and goes by whole points
    hundredth = float(wear(steady, start=0.2, end=0.21).sum())
    assert hundredth == pytest.approx(whole / 80.0, rel=0.03)
    with pytest.raises(
        ModelError, match=r"fewer than two outputs along the belt from 0\.2 s to 0\.2 s, so the friction work"
    ):
        wear(steady, start=0.2, end=0.2)


@pytest.mark.parametrize("wear", [wear_by_arc, wear_by_belt])
def test_work_that_was_not_recorded(steady: Run, wear: Callable[..., xr.DataArray]) -> None:
    older = Run(steady.dataset.drop_vars(["friction_work_on_arc", "friction_work_on_belt"]), steady.drive)
    with pytest.raises(ModelError, match="has no `friction_work_on_"):
        wear(older)


def test_parts_of_an_arc_make_one_and_a_half_of_it(steady: Run) -> None:
    """A quarter of it before the inlet and behind the outlet."""
    wear, drive = wear_by_arc(steady), steady.drive
    np.testing.assert_allclose(wear["part_length"].sum("share"), 1.5 * np.pi * drive.radii, rtol=1e-12)
    np.testing.assert_allclose(wear["angle"], np.pi * np.stack([wear["share"]] * 2), rtol=1e-12)

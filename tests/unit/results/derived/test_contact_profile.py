"""Contact over the arc; on the driver of the made-up run tension falls, on the driven pulley it grows."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn.results import Run
from beltdyn.results.derived import contact_arc

MakeRun = Callable[..., Run]


@pytest.mark.parametrize(("pulley", "sign"), [("driver", -1), ("driven", 1)])
def test_pressure_over_the_angle(run: Run, pulley: str, sign: int) -> None:
    """Tension is linear along half a turn, and so is the pressure T / (R b)."""
    arc = contact_arc(run, pulley)
    ends = (60.0, 30.0) if sign < 0 else (30.0, 60.0)
    expected = np.asarray(np.interp(arc["angle"], [0.0, np.pi], ends)) / 0.08125 / 0.01
    np.testing.assert_allclose(arc["pressure"], expected, rtol=1e-6)
    assert np.all(np.diff(arc["angle"]) > 0.0)
    inside = slice(5, -5)  # elements at the ends lie on spans too
    np.testing.assert_allclose(arc["belt_tension"][inside], expected[inside] * 0.08125 * 0.01, rtol=0.02)
    np.testing.assert_allclose(arc["shear"] * 0.01, arc["friction_force"])
    assert np.all(np.sign(arc["friction_force"]) == -sign)
    assert not arc["sliding"].any()
    on = run.dataset["contact_pulley"].values[-1] == ["driver", "driven"].index(pulley)
    for name in ("friction_force", "slip_velocity"):  # counter-clockwise, as recorded
        np.testing.assert_array_equal(np.sort(arc[name]), np.sort(run.dataset[name].values[-1, on]))
    assert (arc["pressure"].attrs["units"], arc["angle"].attrs["units"]) == ("Pa", "rad")


def test_a_drive_that_runs_backwards_has_its_inlet_at_the_other_end(make_run: MakeRun, run: Run) -> None:
    back = contact_arc(make_run(pulley_speed=-run.dataset["pulley_speed"].values), "driver")
    forth = contact_arc(run, "driver")
    np.testing.assert_allclose(back["angle"], np.pi - forth["angle"][::-1])
    np.testing.assert_allclose(back["friction_force"], -forth["friction_force"][::-1])
    np.testing.assert_allclose(back["pressure"], forth["pressure"][::-1])


def test_a_pulley_that_stands_has_its_inlet_where_the_belt_coordinate_begins(make_run: MakeRun, run: Run) -> None:
    still, turning = (contact_arc(other, "driven") for other in (make_run(pulley_speed=np.zeros((101, 2))), run))
    xr.testing.assert_equal(still, turning)

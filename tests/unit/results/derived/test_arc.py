"""Contact over the arc; on the driver of the made-up run tension falls, on the driven pulley it grows."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.model import Path
from beltdyn.results import Run
from beltdyn.results.arc import angle_from_inlet, arc_ends
from beltdyn.results.derived import contact_arc

MakeRun = Callable[..., Run]


@pytest.mark.parametrize(("pulley", "sign"), [("driver", -1), ("driven", 1)])
def test_pressure_over_the_angle(run: Run, pulley: str, sign: int) -> None:
    """Tension is linear along half a turn, and so is the pressure T / (R b)."""
    arc = contact_arc(run, pulley)
    ends = (60.0, 30.0) if sign < 0 else (30.0, 60.0)
    expected = np.interp(arc["angle"], [0.0, np.pi], ends) / 0.08125 / 0.01
    np.testing.assert_allclose(arc["pressure"], expected, rtol=1e-6)
    assert np.all(np.diff(arc["angle"]) > 0.0)
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


def test_arcs_follow_pulleys_that_move(run: Run) -> None:
    """Turning both centers about the origin turns the inlets."""
    turn = 0.3
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    centers = run.drive.centers
    inlet, wrap = arc_ends(run.drive, centers)
    turned, same = arc_ends(run.drive, centers @ rotation.T)
    np.testing.assert_allclose(np.mod(turned - inlet, 2.0 * np.pi), turn)
    np.testing.assert_allclose(same, wrap)
    np.testing.assert_allclose(np.abs(inlet), 0.5 * np.pi)


def test_arc_of_a_pulley_at_the_back_ends_where_the_span_begins() -> None:
    """Three pulleys inside and one that presses the lower span up from outside, turning clockwise."""
    centers, radii = np.array([[-0.5, 0.0], [0.0, -0.02], [0.5, 0.0], [0.0, 0.6]]), np.array([0.1, -0.05, 0.1, 0.1])
    path = Path(centers, radii)
    drive: Any = SimpleNamespace(path=path)
    inlet, wrap = arc_ends(drive, centers)
    for number, turning in enumerate(np.sign(radii).astype(int)):
        outlet = path.span_points[number : number + 1, 0] - centers[number]
        assert angle_from_inlet(outlet, inlet[number], wrap[number], turning)[0] == pytest.approx(wrap[number])
    assert 0.0 < wrap[1] < 1.0


@given(
    angle=st.floats(-0.4, 4.0), inlet=st.floats(-3.0, 3.0), turning=st.sampled_from([1, -1]), radius=st.floats(0.1, 9.0)
)
def test_angles_are_counted_from_the_inlet_on_either_side(
    angle: float, inlet: float, turning: int, radius: float
) -> None:
    """An arc of pi leaves pi free, half of it at each end; angles within are found again."""
    at = inlet + turning * angle
    place = radius * np.array([[np.cos(at), np.sin(at)]])
    assert angle_from_inlet(place, inlet, np.pi, turning)[0] == pytest.approx(angle, abs=1e-9)

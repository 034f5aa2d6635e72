"""Inlets and wrap angles from circles alone, and angles along an arc."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.model import Path
from beltdyn.results import Run
from beltdyn.results.mechanics import angle_from_inlet, arc_ends


def test_arcs_follow_pulleys_that_move(run: Run) -> None:
    """Turning both centers about the origin turns the inlets."""
    turn = 0.3
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    centers = run.drive.centers
    inlet, wrap = arc_ends(run.prepared, centers)
    turned, same = arc_ends(run.prepared, centers @ rotation.T)
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

"""Pictures of drives: how large they are, and which way pulleys turn."""

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.model import Drive
from beltdyn.show.plot.drive_picture import draw_rotation, extent_of, make_room, size_of


def test_the_picture_holds_pulleys_and_pivots(drive: Drive) -> None:
    """Two pulleys of one radius side by side; an arm from above."""
    (left, _), (right, _) = (pulley.center for pulley in drive.pulleys)
    radius = drive.pulleys[0].radius
    corners = extent_of(drive, drive.path)
    outside = np.abs(drive.path.radii[0])
    np.testing.assert_allclose(corners, [[left - outside, -outside], [right + outside, outside]], rtol=1e-12)
    arm = {"kind": "rotary", "pulley": "driver", "pivot": (left, 10 * radius), "preload": 1.0, "inertia": 1.0}
    higher = drive.replace(tensioner=[arm])
    assert extent_of(higher, drive.path)[1, 1] == pytest.approx(10 * radius, rel=1e-12)
    assert size_of(higher)[1] > size_of(drive)[1]
    assert size_of(higher)[0] < size_of(drive)[0]


def test_what_is_drawn_fits_in_equal_scales(ax: Axes) -> None:
    make_room(ax, np.array([[-1.0, 0.0], [3.0, 1.0]]))
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert left <= -1.0
    assert right >= 3.0
    assert low <= 0.0
    assert high >= 1.0
    assert ax.get_aspect() == 1.0


@pytest.mark.parametrize("speed", [3.0, -3.0])
def test_the_arrow_points_the_way_that_the_pulley_turns(ax: Axes, speed: float) -> None:
    """Over the top of the pulley: to the left where it turns counter-clockwise."""
    draw_rotation(ax, (1.0, 2.0), 0.5, speed)
    arrow: Any = ax.patches[0]
    points = np.asarray(arrow._path_original.vertices)
    assert np.sign(points[0, 0] - points[-1, 0]) == np.sign(speed)
    assert np.all(points[:, 1] > 2.0)
    np.testing.assert_array_less(np.hypot(*(points - [1.0, 2.0]).T), 0.5)


def test_a_pulley_that_stands_has_no_arrow(ax: Axes) -> None:
    draw_rotation(ax, (1.0, 2.0), 0.5, 0.0)
    assert not ax.patches

"""Where pulleys stand and how the belt runs around them, before its state is known."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Drive, dumps, install, loads
from beltdyn.model.layout import lay_out

MakeDrive = Callable[..., Drive]


@pytest.mark.parametrize("layout", ["open", "crossed", "flat", "serpentine"])
def test_the_path_needs_nothing_of_the_state_of_the_belt(make_drive: MakeDrive, layout: str) -> None:
    """A third of the tension leaves the path as it is, to the last bit, while the length follows it."""
    one, other = (make_drive(layout, installed_tension=tension) for tension in (300.0, 100.0))
    assert one.belt_length < other.belt_length
    np.testing.assert_array_equal(one.layout.path.span_points, other.layout.path.span_points)
    assert one.layout.choices == ()


def test_a_layout_stays_when_it_is_laid_out_again(make_drive: MakeDrive) -> None:
    """With the take-up that was found in place of the tension there is nothing to take up."""
    fixed = {"kind": "fixed", "pulley": "idler", "direction": (0, 1)}
    drive = make_drive("flat", tensioner=[fixed], length=2.56, installed_tension=500.0)
    given = drive.layout.given
    settled = given._replace(belt=given.belt.replace(length=2.56, installed_tension=None))
    np.testing.assert_array_equal(lay_out(settled).path.centers, drive.centers)


def test_fixed_tensioner_moves_its_pulley(make_drive: MakeDrive) -> None:
    fixed = {"kind": "fixed", "pulley": "idler", "direction": (3, 4), "take_up": "10 mm"}
    drive = make_drive("flat", tensioner=[fixed])
    np.testing.assert_allclose(drive.centers[1], [0.256, -0.042], rtol=1e-14)
    assert drive.pulleys[1].center == (0.25, -0.05)
    assert loads(dumps(drive)) == drive


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("length", [2.56, 2.62])
def test_take_up_for_a_tension(make_drive: MakeDrive, length: float, sense: int) -> None:
    """The idler climbs for a long belt and sinks for a short one, on its line, however that is directed."""
    fixed = {"kind": "fixed", "pulley": "idler", "direction": (0, sense)}
    drive = make_drive("flat", tensioner=[fixed], length=length, installed_tension=500.0)
    assert drive.belt_length == length
    assert install(drive).tension == pytest.approx(500.0, rel=1e-9)
    assert drive.centers[1, 0] == 0.25
    assert (drive.centers[1, 1] > -0.05) == (length == 2.62)
    assert loads(dumps(drive)) == drive

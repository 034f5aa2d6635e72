"""Pictures of modes."""

from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.show import plot
from beltdyn.vibration.modes import modes


@pytest.fixture(scope="module")
def found(drive: Drive) -> bd.Result:
    return modes(drive, about="rest", count=3)


def test_a_shape(found: bd.Result) -> None:
    ax = plot.mode_shape(found, 2)
    belt = np.array(ax.lines[1].get_data())
    still = np.array(ax.lines[0].get_data())
    away = np.hypot(*(belt - still))
    assert away.max() == pytest.approx(0.06 * float(np.ptp(found.drive.path.centers, axis=0).max() + 0.1625), rel=0.05)
    assert ax.get_title("left").startswith("2: ")
    assert "span" in ax.get_title("left")


def test_an_unknown_mode(found: bd.Result) -> None:
    with pytest.raises(ModelError, match="mode = 9 does not exist; this result has modes 1, 2, 3"):
        plot.mode_shape(found, 9)


@pytest.mark.slow
def test_all_on_a_page_and_moving(found: bd.Result, tmp_path: Path) -> None:
    assert [path.name for path in plot.save_all(found, tmp_path)] == ["mode_shape.png"]
    film = plot.animate_modes(found, tmp_path / "modes.gif")
    from PIL import Image

    with Image.open(film) as picture:
        assert getattr(picture, "n_frames", 1) > 10


def test_other_results_have_no_modes(drive: Drive, tmp_path: Path) -> None:
    other = bd.extend.build_result("natural", drive, {}, {})
    with pytest.raises(ModelError, match="not of natural"):
        plot.animate_modes(other, tmp_path / "modes.gif")

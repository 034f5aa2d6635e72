"""The figure of tensioner sheets."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import LineCollection

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, load
from beltdyn.points.tensioner_sheet import COLUMNS
from beltdyn.results import Result, Variable, build_result
from beltdyn.show import plot


@pytest.fixture
def sheet() -> Result:
    drive = load(Path(str(files("beltdyn"))) / "examples" / "accessory_drive.toml")
    size = {"position": [0.1, 0.0], "tension": [200.0, 300.0], "hub_load": [150.0, 220.0], "belt_length": [1.52, 1.51]}
    size |= {"tension_after_tensioning": [180.0, 280.0], "tension_after_yielding": [290.0, 380.0]}
    variables = {name: (COLUMNS[name].variable(True), np.array(values)) for name, values in size.items()}
    names = {"state": (Variable(("state",), "1", "State", "str"), ["longest belt", "nominal belt"])}
    result = build_result("tensioner_sheet", drive, variables, names)
    result.dataset.attrs["pulley"] = "tensioner"
    return result


def test_points_lie_on_the_line_by_hand(sheet: Result) -> None:
    """Over the angle of an arm from (130, 80) to (85, 140) mm, which lengthens the path counter-clockwise."""
    ax, nominal = plot.tensioner_sheet(sheet), np.degrees(np.arctan2(60.0, -45.0))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Arm angle [°]", "Tension [N]")
    line = ax.lines[0]
    assert np.asarray(line.get_xdata(), dtype=float)[[0, -1]] == pytest.approx(nominal + np.degrees([0.0, 0.1]))
    assert np.asarray(line.get_ydata(), dtype=float)[0] == pytest.approx(295.5, abs=0.1)
    (bars,) = (one for one in ax.collections if isinstance(one, LineCollection))
    low, high = np.array(bars.get_segments())[1, :, 1]
    assert (low, high) == pytest.approx((280.0, 380.0))
    stops = [np.asarray(one.get_xdata(), dtype=float)[0] for one in ax.lines[-2:]]
    assert stops == pytest.approx([nominal - 15.0, nominal + 25.0])


def test_both_panels_are_saved(sheet: Result, tmp_path: Path) -> None:
    assert [path.stem for path in plot.save_all(sheet, tmp_path)] == ["tensioner_sheet"]


def test_runs_have_no_sheet(drive: Drive) -> None:
    with pytest.raises(ModelError, match="shows results of tensioner_sheet; these are of equilibrium"):
        plot.tensioner_sheet(bd.equilibrium(drive))

"""Tornado figures."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from beltdyn.designs.sensitivity import with_spread
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result
from beltdyn.show import plot


@pytest.fixture
def result(drive: Drive) -> Result:
    """Two results over three numbers."""
    both, unit = ("result", "number"), Variable(("result",), "1", "unit", "str")
    variables: dict[str, Any] = {
        "effect": (Variable(both, "1", "effect"), [[1e-3, -4e-3, np.nan], [5.0, 6.0, 7.0]]),
        "value": (Variable(("result",), "1", "value"), [0.9, 300.0]),
    }
    coordinates: dict[str, Any] = {
        "result": (Variable(("result",), "1", "result", "str"), ["efficiency", "hub_load[a]"]),
        "number": (Variable(("number",), "1", "number", "str"), ["one", "two", "three"]),
        "unit": (unit, ["", "N"]),
    }
    return build_result("sensitivity", drive, variables, coordinates)


def widths(ax: Axes) -> list[float]:
    return [bar.get_width() for bar in ax.patches if isinstance(bar, Rectangle)]


def test_the_largest_effect_is_on_top_in_percent(result: Result) -> None:
    ax = plot.sensitivity(result)
    assert [text.get_text() for text in ax.get_yticklabels()] == ["three", "one", "two"]
    assert widths(ax) == pytest.approx([0.0, 0.1, -0.4])
    assert ax.get_xlabel() == "efficiency = 90 %\nchange per 1 % or 1 mm [%]"


def test_a_result_by_name(result: Result) -> None:
    ax = plot.sensitivity(result, "hub_load[a]")
    assert "hub_load[a] = 300 N" in ax.get_xlabel()
    assert widths(ax) == [5.0, 6.0, 7.0]


def test_an_unknown_result_is_refused(result: Result) -> None:
    with pytest.raises(ModelError, match=r"'efficency'.*efficiency"):
        plot.sensitivity(result, "efficency")


def test_all_panels_are_saved(result: Result, tmp_path: Path) -> None:
    assert [path.stem for path in plot.save_all(result, tmp_path)] == ["sensitivity"]


def test_tolerances_stand_above_their_spread(result: Result) -> None:
    """Numbers without tolerance are left out."""
    spread = with_spread(
        Result(result.dataset.assign(derivative=result.dataset.effect), result.drive), {"one": 3.0, "two": 1.0}, None
    )
    ax = plot.tolerances(spread)
    assert [text.get_text() for text in ax.get_yticklabels()] == ["all, independent", "one", "two"]
    assert widths(ax) == pytest.approx([0.5, 0.3, -0.4])


def test_no_tolerances_no_figure(result: Result) -> None:
    with pytest.raises(ModelError, match="has no tolerances"):
        plot.tolerances(result)

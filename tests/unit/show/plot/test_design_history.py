"""Figures of optimizations."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result
from beltdyn.show import plot


@pytest.fixture
def result(drive: Drive) -> Result:
    """Four designs: the start, a better one that violates a limit, one that does not run, and the best."""
    text = Variable(("requirement",), "1", "unit", "str")
    variables: dict[str, Any] = {
        "design_goal": (Variable(("design",), "1", "goal"), [900.0, 600.0, np.nan, 700.0]),
        "design_violation": (Variable(("design",), "1", "violation"), [0.0, 0.2, np.nan, 0.0]),
        "design_number": (Variable(("design", "number"), "1", "number"), [[1.0], [2.0], [3.0], [1.5]]),
        "least": (Variable(("number",), "1", "least"), [0.0]),
        "largest": (Variable(("number",), "1", "largest"), [4.0]),
        "requirement_unit": (text, ["N"]),
    }
    coordinates: dict[str, Any] = {
        "number": (Variable(("number",), "1", "number", "str"), ["belt.width"]),
        "requirement": (text, ["minimize largest hub_load"]),
    }
    made = build_result("optimize", drive, variables, coordinates)
    return Result(made.dataset.assign_attrs(title="Belt drive: minimize largest hub_load"), drive)


def test_the_best_until_then_keeps_to_limits(result: Result) -> None:
    ax = plot.optimization(result)
    lines = {str(line.get_label()): np.asarray(line.get_ydata(), dtype=float) for line in ax.get_lines()}
    np.testing.assert_array_equal(lines["best so far"], [900.0, 900.0, 900.0, 700.0])
    np.testing.assert_array_equal(lines["within all limits"], [900.0, 700.0])
    np.testing.assert_array_equal(lines["violates limits"], [600.0])
    assert len(lines["no steady running"]) == 1
    assert ax.get_ylabel() == "largest hub_load [N]"


def test_all_panels_are_saved(result: Result, tmp_path: Path) -> None:
    assert [path.stem for path in plot.save_all(result, tmp_path)] == ["optimization"]

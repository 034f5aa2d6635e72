"""The spread of results by tolerances against closed forms."""

import numpy as np
import pytest

from beltdyn.designs.sensitivity import with_spread
from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result


def test_the_root_of_squares_and_the_sum(drive: Drive) -> None:
    variables = {
        "derivative": (Variable(("result", "number"), "1", "d"), [[3.0, -4.0, 7.0], [np.nan, 2.0, 1.0]]),
    }
    coordinates = {
        "result": (Variable(("result",), "1", "r", "str"), ["a", "b"]),
        "number": (Variable(("number",), "1", "n", "str"), ["x", "y", "z"]),
    }
    given: Result = build_result("sensitivity", drive, variables, coordinates)
    found = with_spread(given, {"x": 0.1, "y": 0.1}, np.array([[1.0, 2.0], [3.0, 2.0]])).dataset
    assert found.spread.values == pytest.approx([0.5, 0.2])
    assert found.worst_case.values == pytest.approx([0.7, 0.2])
    assert found.mean_of_points.values == pytest.approx([2.0, 2.0])
    assert found.spread_of_points.values == pytest.approx([2.0 * np.sqrt(2.0), 0.0])

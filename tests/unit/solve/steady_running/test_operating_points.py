"""The order in which the points of a table are found, and the way from one to the next."""

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results import Run, Variable
from beltdyn.solve.steady import steady_state
from beltdyn.solve.steady_running import operating_points
from beltdyn.solve.steady_running.changed_drive import at_speed, held_at
from beltdyn.solve.steady_running.operating_points import OperatingPoints, serpentine
from validation.published import two_pulley
from validation.published.cases import better

FIRST, SPAN = 10.0, 8.0
"""Speed of the first point and the way to the second one, rad/s."""


def test_each_point_is_next_to_the_one_before() -> None:
    assert list(serpentine((2, 3))) == [(0, 0), (0, 1), (0, 2), (1, 2), (1, 1), (1, 0)]
    assert list(serpentine((3,))) == [(0,), (1,), (2,)]


@pytest.mark.parametrize(("reach", "is_found"), [(SPAN, True), (0.3 * SPAN, True), (0.01 * SPAN, False)])
def test_a_point_that_is_far_is_found_by_parts_of_the_way(
    monkeypatch: pytest.MonkeyPatch, reach: float, is_found: bool
) -> None:
    """A search that reaches no further than some change of the speed, at once or by halves of the way."""
    drive = held_at(better(two_pulley()), None)

    def speed(of: Drive) -> float:
        return float(of.pulleys[0].driven_speed())

    def search(of: Drive, *, force_tolerance: float | None, start: Run | None) -> Run:
        if start is not None and abs(speed(of) - speed(start.drive)) > reach:
            raise ConvergenceError(f"too far to {speed(of):g}")
        return steady_state(of, force_tolerance=force_tolerance)

    monkeypatch.setattr(operating_points, "steady_state", search)
    axes = {"speed": (Variable(("speed",), "rad/s", "Speed"), [FIRST, FIRST + SPAN])}
    with OperatingPoints("map", drive, axes) as table:
        table.find((0,), at_speed(drive, 0, FIRST), 0.05)
        second = at_speed(drive, 0, FIRST + SPAN)
        found = table.find((1,), second, 0.05, lambda part: at_speed(drive, 0, FIRST + part * SPAN))
    speeds = table.result().dataset.pulley_speed[:, 0]
    np.testing.assert_allclose(speeds, [FIRST, FIRST + SPAN if is_found else np.nan])
    assert (found is not None) == is_found
    assert (table.arrays["failure"][1] == "too far to 18") == (not is_found)

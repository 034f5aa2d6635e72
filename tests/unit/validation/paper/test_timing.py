import numpy as np
import pytest

from validation.paper.statement import Verdict
from validation.paper.timing import below, with_spread


@pytest.mark.parametrize(
    ("times", "others", "expected"),
    [
        ([1.0, 1.2], [1.3, 9.0], Verdict.HOLDS),
        ([1.4, 1.5], [1.0, 1.3], Verdict.FAILS),
        ([1.0, 1.4], [1.3, 1.5], Verdict.OPEN),
        ([1.0, 9.0], [2.0, 3.0], Verdict.OPEN),
    ],
)
def test_ranges_that_overlap_decide_nothing(times: list[float], others: list[float], expected: Verdict) -> None:
    assert below(np.array(times), np.array(others)) is expected


def test_spread() -> None:
    assert with_spread(np.array([0.3, 0.1, 0.2])) == "0.200 (0.100–0.300)"

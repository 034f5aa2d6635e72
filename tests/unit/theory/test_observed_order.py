"""Orders of sequences whose limit and order are known, with levels in any ratio."""

import numpy as np
import pytest

from beltdyn.theory.observed_order import extrapolated, observed_order


@pytest.mark.parametrize("order", [0.3, 1.0, 2.0, 3.7, 8.0])
@pytest.mark.parametrize("sizes", [(0.4, 0.2, 0.1), (0.5, 0.31, 0.23), (1e-3, 1e-4, 1e-5)])
@pytest.mark.parametrize("slope", [-3.0, 0.2])
def test_a_power_law_has_its_order_and_limit(sizes: tuple[float, ...], order: float, slope: float) -> None:
    values = [7.0 + slope * size**order for size in sizes]
    if abs(values[1] - values[2]) < 1e-9:
        return  # rounding is a part of the difference
    assert observed_order(sizes, values) == pytest.approx(order, rel=1e-5)
    assert extrapolated(sizes[1:], values[1:], order) == pytest.approx(7.0, rel=1e-9)


@pytest.mark.parametrize(
    "values",
    [
        [1.0, 2.0, 1.5],  # to and fro
        [1.0, 1.1, 1.3],  # differences that grow
        [1.0, 1.1, 1.2],  # and that stay
        [1.1, 1.0, 1.0],  # nothing is left
        [np.nan, 1.1, 1.0],
    ],
)
def test_what_does_not_approach_a_limit_has_no_order(values: list[float]) -> None:
    assert np.isnan(observed_order([0.4, 0.2, 0.1], values))

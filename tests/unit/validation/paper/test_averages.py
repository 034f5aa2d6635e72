"""Mean contact forces of a run made by formulas, whose tension is linear over the arcs, and stands still in space."""

import numpy as np
import pytest

from beltdyn.quadrature import gauss_points
from beltdyn.results import Run
from validation.paper.averages import BINS, contact_samples

RADIUS = 0.08125
TIGHT, SLACK = 60.0, 30.0
PLACE = (np.arange(BINS) + 0.5) / BINS


@pytest.mark.parametrize(("pulley", "first", "last"), [(0, TIGHT, SLACK), (1, SLACK, TIGHT)])
def test_normal_force(run: Run, pulley: int, first: float, last: float) -> None:
    expected = (first + (last - first) * PLACE) / RADIUS
    part = abs(last - first) / RADIUS / BINS
    np.testing.assert_allclose(contact_samples(run)[pulley].mean("normal"), expected, atol=part)


@pytest.mark.parametrize(("pulley", "side"), [(0, 1.0), (1, -1.0)])
def test_friction(run: Run, pulley: int, side: float) -> None:
    expected = side * (TIGHT - SLACK) / (np.pi * RADIUS)
    np.testing.assert_allclose(contact_samples(run)[pulley].mean("friction"), expected, rtol=1e-7)  # single precision


def test_points_off_the_rim_are_left_out(run: Run) -> None:
    """The spans lie within the half planes of the arcs' angles only where they touch them."""
    samples = contact_samples(run)[0]
    assert np.all((samples.place >= 0.0) & (samples.place < 1.0))
    assert np.all(samples.normal > 0.0)


def test_unevenness(run: Run) -> None:
    """Of a force that stands still it is what the force changes by within a part of the arc."""
    change = (TIGHT - SLACK) / (0.5 * (TIGHT + SLACK)) / BINS
    assert 0.0 < contact_samples(run)[1].unevenness() <= change


def test_unevenness_in_time(run: Run) -> None:
    """A force that swings by a tenth has the unevenness of a sine, 0.1 / sqrt(2)."""
    data = run.dataset.copy()
    data["normal_force"] = data["normal_force"] * (1.0 + 0.1 * np.sin(2.0 * np.pi * data["field_time"] / 0.1))
    uneven = contact_samples(Run(data, run.drive))[1].unevenness()
    assert uneven == pytest.approx(0.1 / np.sqrt(2.0), rel=0.1)


def test_points_count_by_the_part_of_the_element_that_they_stand_for(run: Run) -> None:
    """A force of one at the middle Gauss point and zero at the four others is its weight in the mean."""
    data = run.dataset.copy()
    middle = np.arange(data.sizes["contact_point"]) % 5 == 2
    data["normal_force"] = data["normal_force"] * 0.0 + middle
    mean = contact_samples(Run(data, run.drive))[1].mean("normal")
    assert np.mean(mean) == pytest.approx(gauss_points(5)[1][2], rel=0.1)

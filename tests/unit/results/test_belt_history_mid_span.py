"""Where the free belt crosses the middle of a span: straight lines, parabolas, and belts that have left a pulley."""

import numpy as np
import pytest

from beltdyn.results.belt_history import fill_mid_spans

LINES = np.array([[[[0.0, 0.0], [2.0, 0.0]], [[2.0, 1.0], [0.0, 1.0]]]])
"""A span to the right below, and one to the left above."""
TOUCHED = np.array([[0, -1, -1, -1, -1, 1, 1, -1, -1, -1, -1, 0]])
ALONG = np.array([-0.1, 0.3, 0.9, 1.2, 1.8, 2.1, 2.1, 1.7, 1.1, 0.8, 0.2, -0.1])


def displaced(below: np.ndarray, above: np.ndarray, touched: np.ndarray = TOUCHED) -> list[float]:
    height = np.where(np.arange(12) < 6, below, 1.0 + above)
    result = np.full((1, 2), np.nan)
    fill_mid_spans(LINES, np.stack([ALONG, height], axis=-1)[None], touched, False, result)
    return list(result[0])


def test_a_belt_on_the_line_is_not_displaced() -> None:
    assert displaced(0.0 * ALONG, 0.0 * ALONG) == pytest.approx([0.0, 0.0], abs=1e-15)


def test_left_of_the_way_of_the_belt_is_positive() -> None:
    """Up on the span to the right, down on that to the left: inwards on both."""
    raised = np.full(12, 0.1)
    assert displaced(raised, raised) == pytest.approx([0.1, -0.1], rel=1e-14)


def test_between_two_points_the_belt_is_straight() -> None:
    """A belt across the line, 0.1 m of height on a meter: 0 at x = 0.4 and 0.06 in the middle, x = 1."""
    slope = 0.1 * (ALONG - 0.4)
    assert displaced(slope, slope) == pytest.approx([0.06, -0.06], rel=1e-12)


@pytest.mark.parametrize("shift", range(12))
def test_it_does_not_matter_where_the_belt_coordinate_begins(shift: int) -> None:
    height = np.where(np.arange(12) < 6, 0.1 * ALONG, 1.0 + 0.2 * ALONG)
    places, result = np.stack([ALONG, height], axis=-1), np.full((1, 2), np.nan)
    fill_mid_spans(LINES, np.roll(places, shift, axis=0)[None], np.roll(TOUCHED, shift, axis=1), False, result)
    assert result[0] == pytest.approx([0.1, -0.2], rel=1e-12)


def test_a_pulley_that_the_belt_has_left_has_no_spans() -> None:
    nowhere, one = np.full_like(TOUCHED, -1), np.where(TOUCHED == 1, -1, TOUCHED)
    for touched in (nowhere, one):
        assert np.isnan(displaced(0.0 * ALONG, 0.0 * ALONG, touched)).all()


def test_an_open_belt_has_a_span_before_its_first_pulley_and_one_behind_its_last() -> None:
    """The last one is that from the beginning of the belt."""
    touched = np.where(TOUCHED == 1, 0, -1)
    height = np.where(np.arange(12) < 6, 0.1 * ALONG, 1.0 + 0.2 * ALONG)
    result = np.full((1, 2), np.nan)
    fill_mid_spans(LINES[:, ::-1].copy(), np.stack([ALONG, height], axis=-1)[None], touched, True, result)
    assert result[0] == pytest.approx([-0.2, 0.1], rel=1e-12)

"""Spans of axes, and limits inside them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes

from beltdyn.show.plot.style import LEAST_SHARE, LIMIT, draw_limit, show_enough, spread, unit_of

numbers = st.floats(-1e6, 1e6)


@given(numbers, st.floats(0.0, 1e3), st.sampled_from(["", "N", "rad/s", "%"]))
def test_a_range_is_kept_and_widened_to_a_share_of_its_values(low: float, span: float, unit: str) -> None:
    high = low + span
    bottom, top = spread(low, high, unit)
    slack = 1e-9 * max(abs(low), abs(high), 1.0)
    assert bottom <= low + slack
    assert top >= high - slack
    assert top - bottom >= LEAST_SHARE * max(abs(low), abs(high)) - slack
    assert bottom >= 0.0 or low < 0.0
    if high - low >= 0.2 * max(abs(low), abs(high), 10.0):
        assert (bottom, top) == (low, high)


@pytest.mark.parametrize(
    ("low", "high", "unit", "expected"),
    [
        (99.092, 99.112, "%", (95.0, 100.0)),
        (399.0, 401.0, "N", (389.975, 410.025)),
        (-1e-7, 1e-7, "rad/s", (-0.05, 0.05)),
        (1e-9, 2e-9, "N", (0.0, 0.1)),
        (100.0, 200.0, "N", (100.0, 200.0)),
    ],
)
def test_almost_constant_quantities(low: float, high: float, unit: str, expected: tuple[float, float]) -> None:
    assert spread(low, high, unit) == pytest.approx(expected, abs=0.05 if unit == "%" else 1e-9)


def test_axes_are_widened_and_fit_more_that_is_drawn_later(ax: Axes) -> None:
    ax.set_ylabel("Tension [N]")
    assert unit_of(ax) == "N"
    ax.plot([0.0, 1.0], [400.0, 400.001])
    show_enough(ax)
    low, high = ax.get_ylim()
    assert low < 391.0
    assert high > 409.0
    ax.plot([0.0, 1.0], [100.0, 700.0])
    assert ax.get_ylim()[1] > 700.0


def test_chosen_and_logarithmic_axes_are_left_alone(ax: Axes) -> None:
    ax.plot([1.0, 2.0], [1.0, 1.001])
    ax.set_ylim(0.999, 1.002)
    show_enough(ax)
    assert ax.get_ylim() == (0.999, 1.002)
    ax.autoscale(axis="y")
    ax.set_yscale("log")
    before = ax.get_ylim()
    show_enough(ax)
    assert ax.get_ylim() == before


@pytest.mark.parametrize("value", [60.0, 130.0, -5.0, 40.0])
@pytest.mark.parametrize("chosen", [False, True])
def test_a_limit_nearby_and_its_words_are_inside_the_axes(ax: Axes, value: float, chosen: bool) -> None:
    ax.plot([0.0, 1.0], [30.0, 70.0])
    if chosen:
        ax.set_ylim(25.0, 75.0)
    draw_limit(ax, value, "limit")
    ax.figure.canvas.figure.draw_without_rendering()
    low, high = ax.get_ylim()
    assert low < value < high
    (words,) = (text for text in ax.texts if text.get_gid() == LIMIT)
    inside, box = ax.get_window_extent(), words.get_window_extent()
    assert inside.y0 - 1.0 <= box.y0
    assert box.y1 <= inside.y1 + 1.0


@pytest.mark.parametrize(("value", "arrow"), [(1e4, "↑"), (-1e4, "↓")])
def test_limits_far_off_squeeze_nothing_and_do_not_cover_each_other(ax: Axes, value: float, arrow: str) -> None:
    ax.plot([0.0, 1.0], [30.0, 70.0])
    before = ax.get_ylim()
    draw_limit(ax, value, "one")
    draw_limit(ax, 2.0 * value, "other")
    ax.figure.canvas.figure.draw_without_rendering()
    assert ax.get_ylim() == pytest.approx(before)
    one, other = ax.texts
    assert (one.get_text(), other.get_text()) == (f"one {arrow}", f"other {arrow}")
    assert not one.get_window_extent().overlaps(other.get_window_extent())
    assert np.all(np.abs(np.subtract(one.xy, (1.0, float(value > 0)))) < 1e-12)  # type: ignore[attr-defined]

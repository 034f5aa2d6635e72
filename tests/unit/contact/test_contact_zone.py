"""Touching intervals against dense sampling of random belt-like curves, and quick rejection against the same."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_zone import MAX_DEGREE, fill_bernstein, out_of_reach, touching_intervals, zone_scratch
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import Round

UNIT = PulleyState(0.0, 0.0, Round(1.0), 0.0, 0.5)
XI = np.linspace(0.0, 1.0, 2001)
GRAZING = 1e-6
"""Between two samples a curve of these lengths sags by less."""


def points(control: FloatArray, places: FloatArray) -> FloatArray:
    """Points of the curve, shape (k, 2)."""
    weights = np.empty((places.size, len(control)))
    for xi, row in zip(places, weights, strict=True):
        fill_bernstein(xi, row)
    return np.asarray(weights @ control)


def overlap(control: FloatArray) -> FloatArray:
    return np.asarray(1.0 - np.linalg.norm(points(control, XI), axis=1))


def intervals(control: FloatArray, pulley: PulleyState = UNIT) -> FloatArray:
    zone = zone_scratch(len(control))
    count = touching_intervals(control, pulley, zone)
    return np.array(zone.intervals[:count])


def assert_exact(control: FloatArray) -> None:
    """The intervals hold those samples that are clearly inside, and none that is clearly outside."""
    depth = overlap(control)
    inside = np.zeros(XI.size, dtype=bool)
    for start, end in intervals(control):
        inside |= (start <= XI) & (end >= XI)
    clear = np.abs(depth) > GRAZING
    np.testing.assert_array_equal(inside[clear], depth[clear] > 0)


@given(st.data())
def test_intervals_hold_exactly_the_points_inside(belt_like: st.SearchStrategy[FloatArray], data: Any) -> None:
    assert_exact(data.draw(belt_like))


@pytest.mark.parametrize("degree", [1, 2, *(pytest.param(one, marks=pytest.mark.slow) for one in (4, 5, 7))])
@given(seed=st.integers(0, 2**32 - 1), size=st.floats(0.1, 1.0))
def test_intervals_of_curves_of_any_degree(degree: int, seed: int, size: float) -> None:
    """Random curves that wind near the rim; the higher the degree, the more often they cross it."""
    random = np.random.default_rng(seed)
    begin, end = np.array([1.0, 0.0]) + size * random.normal(size=(2, 2))
    chord = np.linspace(begin, end, degree + 1)
    assert_exact(chord + size * random.normal(size=chord.shape))


@pytest.mark.slow
@given(st.data())
def test_a_curve_of_a_higher_degree_touches_at_the_same_places(
    belt_like: st.SearchStrategy[FloatArray], elevate: Callable[[FloatArray, int], FloatArray], data: Any
) -> None:
    assert_exact(elevate(data.draw(belt_like), 5))


def test_an_element_that_begins_along_the_rim_and_dips_out_of_it(make_curve: Callable[..., FloatArray]) -> None:
    control = make_curve(0.125, 1.0, 0.0, 0.75, 0.125, 0.625)  # overlap and its slope begin at zero, up to rounding
    assert 1e-5 < -overlap(control).min() < 1e-4
    assert_exact(control)


@given(st.data())
def test_inner_ends_lie_on_the_pulley(belt_like: st.SearchStrategy[FloatArray], data: Any) -> None:
    control = data.draw(belt_like)
    ends = intervals(control).ravel()
    assert np.all(np.diff(ends) >= 0.0)
    on_rim = points(control, ends[(ends > 0.0) & (ends < 1.0)])
    np.testing.assert_allclose(np.linalg.norm(on_rim, axis=1), 1.0, atol=1e-12)  # resolution of the roots


@given(st.lists(st.floats(-1.5, 1.5), min_size=8, max_size=8), st.floats(0.0, 3.0))
def test_an_element_that_touches_is_never_rejected(numbers: list[float], shift: float) -> None:
    control = np.array(numbers).reshape(4, 2) + np.array([shift, 0.0])
    assert not (out_of_reach(control, UNIT) and np.any(overlap(control) >= 0.0))


@given(st.data())
def test_a_rejected_element_has_no_intervals(belt_like: st.SearchStrategy[FloatArray], data: Any) -> None:
    control = data.draw(belt_like)
    assert not (out_of_reach(control, UNIT) and len(intervals(control)))


def test_quick_rejection_sees_a_distant_element() -> None:
    assert out_of_reach(np.array([[2.0, -1.0], [2.1, 0.0], [2.1, 1.0], [2.0, 2.0]]), UNIT)


@pytest.mark.parametrize(
    ("height", "half"), [(0.0, 1.0), (0.6, 0.8), (0.999, np.sqrt(1 - 0.999**2)), (1.0 - 1e-9, np.sqrt(2e-9))]
)
def test_chord_of_a_straight_element(height: float, half: float) -> None:
    control = np.stack([np.linspace(-1.5, 1.5, 4), np.full(4, height)], axis=1)
    np.testing.assert_allclose(intervals(control), [[0.5 - half / 3, 0.5 + half / 3]], atol=1e-9)


@pytest.mark.parametrize("place", [1e-4, 0.1, 0.3, 0.5, 0.86])
def test_a_dip_too_short_to_be_seen_does_no_harm(place: float) -> None:
    """A straight element that grazes a circle over less than 2^-12 of its length touches there or nowhere."""
    half = np.sqrt(2e-9) / 3.0
    along = 3.0 * (np.linspace(0.0, 1.0, 4) - place)
    found = intervals(np.stack([along, np.full(4, 1.0 - 1e-9)], axis=1))
    if len(found):
        np.testing.assert_allclose(found, [[place - half, place + half]], atol=1e-9)


@pytest.mark.parametrize(("end", "stop"), [((0.0, 0.0), 1.0), ((-3.0, 0.0), 0.5)], ids=["center", "through"])
def test_an_element_that_begins_on_the_rim_and_goes_in_touches_from_there(
    end: tuple[float, float], stop: float
) -> None:
    """Its overlap begins at zero exactly."""
    np.testing.assert_allclose(intervals(np.array([(1.0, 0.0), end])), [[0.0, stop]], atol=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["begins outside", "begins inside"])
def test_a_wave_touches_at_each_crest(wave: Callable[[float], FloatArray], sign: float) -> None:
    control = wave(sign)
    assert len(intervals(control)) == 4
    assert_exact(control)


def test_a_wave_written_in_the_highest_degree(
    wave: Callable[[float], FloatArray], elevate: Callable[[FloatArray, int], FloatArray]
) -> None:
    raised = elevate(wave(1.0), MAX_DEGREE)
    assert len(raised) == MAX_DEGREE + 1
    np.testing.assert_allclose(intervals(raised), intervals(wave(1.0)), atol=1e-11)  # both to 1e-13


@pytest.mark.parametrize(("shift", "expected"), [(0.0, [[0.0, 1.0]]), (5.0, np.empty((0, 2)))], ids=["inside", "away"])
def test_whole_element(shift: float, expected: Any) -> None:
    control = np.stack([np.linspace(-0.5, 0.5, 4) + shift, np.full(4, 0.1)], axis=1)
    np.testing.assert_array_equal(intervals(control), expected)


def test_position_and_size_of_the_pulley_do_not_matter() -> None:
    control = np.stack([np.linspace(-1.5, 1.5, 4), np.full(4, 0.6)], axis=1)
    moved = intervals(0.01 * control + [3.0, -4.0], PulleyState(3.0, -4.0, Round(0.01), 50.0, 0.5))
    np.testing.assert_allclose(
        moved, intervals(control), atol=1e-10
    )  # cancellation in coordinates 400 times the radius


@given(st.lists(st.floats(-2.5, 2.5), min_size=8, max_size=8), st.sampled_from([0.05, 1.0, 3.0]))
def test_quick_rejection_goes_by_what_the_element_is_to_the_pulley(numbers: list[float], size: float) -> None:
    """Moved and enlarged together they are the same; so they are if turned or seen in a mirror."""
    control = np.array(numbers).reshape(4, 2)
    away = out_of_reach(control, UNIT)
    moved = out_of_reach(
        size * control + [8.0, -3.0], UNIT._replace(center_x=8.0, center_y=-3.0, surface=Round(size * (1.0 + 1e-9)))
    )
    wider = out_of_reach(control, UNIT._replace(surface=Round(1.0 + 2e-9)))
    assert moved in (away, wider)  # at the very limit rounding decides
    assert out_of_reach(control * [1.0, -1.0], UNIT) == away
    assert out_of_reach(control[:, ::-1] * [-1.0, 1.0], UNIT) == away


@pytest.mark.parametrize("far", [1.001, 5.0])
def test_quick_rejection_sees_straight_elements_beyond_a_tangent(far: float) -> None:
    control = np.array([[far, -0.6], [far, -0.2], [far, 0.2], [far, 0.6]])
    assert out_of_reach(control, UNIT)
    assert not out_of_reach(control * [0.998 / far, 1.0], UNIT)


@pytest.mark.parametrize("angle", np.linspace(0.0, 2.0 * np.pi, 13))
def test_quick_rejection_does_not_depend_on_where_the_element_lies(angle: float) -> None:
    """An element 1 mm outside a tangent is rejected, one 2 mm deeper is not, wherever on the rim of 1 m they lie."""
    turn, center = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]), np.array([3.0, -2.0])
    moved = UNIT._replace(center_x=center[0], center_y=center[1])
    for height, beyond in ((1.001, True), (0.999, False)):
        control = np.stack([np.full(4, height), np.array([-0.3, -0.1, 0.1, 0.3])], axis=1)
        assert out_of_reach(center + control @ turn.T, moved) == beyond

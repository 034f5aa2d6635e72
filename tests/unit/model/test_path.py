import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.model import Path

ANGLES = st.floats(-math.pi, math.pi)
SHIFTS = st.floats(-10, 10)


def path(*circles: tuple[float, float, float]) -> Path:
    table = np.array(circles)
    return Path(table[:, :2], table[:, 2])


THREE = ((0.0, 0.0, 0.1), (0.5, 0.05, 0.07), (0.2, 0.4, 0.05))


def test_equal_radii() -> None:
    laid = path((-0.191441, 0, 0.08125), (0.191441, 0, 0.08125))
    np.testing.assert_allclose(laid.span_lengths, 0.382882)
    np.testing.assert_allclose(laid.wrap_angles, math.pi)
    np.testing.assert_allclose(laid.span_directions, [[1, 0], [-1, 0]], atol=1e-15)
    np.testing.assert_allclose(laid.span_points[0], [[-0.191441, -0.08125], [0.191441, -0.08125]], atol=1e-15)
    np.testing.assert_allclose(laid.span_points[1], [[0.191441, 0.08125], [-0.191441, 0.08125]], atol=1e-15)
    assert laid.length == pytest.approx(2 * 0.382882 + 2 * math.pi * 0.08125)


def test_unequal_radii() -> None:
    distance, large, small = 0.382882, 0.1218, 0.08125
    laid = path((0, 0, large), (distance, 0, small))
    beta = math.asin((large - small) / distance)
    np.testing.assert_allclose(laid.wrap_angles, [math.pi + 2 * beta, math.pi - 2 * beta])
    np.testing.assert_allclose(laid.span_lengths, distance * math.cos(beta))
    np.testing.assert_allclose(laid.span_directions[0], [math.cos(beta), math.sin(beta)])
    expected = 2 * distance * math.cos(beta) + large * (math.pi + 2 * beta) + small * (math.pi - 2 * beta)
    assert laid.length == pytest.approx(expected)


def test_three_equal_pulleys() -> None:
    """Around equal circles, the belt is the triangle of the centers and one full circle."""
    laid = path((0, 0, 0.1), (0.3, 0, 0.1), (0, 0.4, 0.1))
    np.testing.assert_allclose(laid.span_lengths, [0.3, 0.5, 0.4])
    np.testing.assert_allclose(laid.wrap_angles, [math.pi / 2, math.pi - math.atan(4 / 3), math.pi - math.atan(3 / 4)])
    assert laid.length == pytest.approx(1.2 + 2 * math.pi * 0.1)


def test_crossed_belt() -> None:
    """A pulley of negative radius turns clockwise: here the spans cross between the pulleys."""
    laid = path((0, 0, 0.1), (0.5, 0, -0.1))
    beta = math.asin(0.2 / 0.5)
    np.testing.assert_allclose(laid.wrap_angles, math.pi + 2 * beta)
    np.testing.assert_allclose(laid.span_lengths, 0.5 * math.cos(beta))
    assert laid.total_turning == pytest.approx(0)


def test_order_along_the_path() -> None:
    """Span 0, the arc of pulley 1, span 1, the arc of pulley 2, span 2, the arc of pulley 0."""
    laid = path(*THREE)
    radii = np.array([circle[2] for circle in THREE])
    ends = np.cumsum(np.stack([laid.span_lengths, np.roll(laid.wrap_angles * radii, -1)], axis=1))
    points = laid.position(np.concatenate([[0.0], ends]))
    np.testing.assert_allclose(points[:-1].reshape(3, 2, 2), laid.span_points, atol=1e-14)
    np.testing.assert_allclose(points[-1], points[0], atol=1e-14)
    assert ends[-1] == pytest.approx(laid.length)


def test_points_lie_on_the_pulleys_or_between() -> None:
    laid = path(*THREE)
    points = laid.position(np.linspace(0, laid.length, 500))
    distance = np.linalg.norm(points[:, None] - laid.centers, axis=2) - laid.radii
    assert np.all(distance > -1e-12)


@given(st.floats(-3, 3))
def test_tangent_is_the_derivative_of_position(s: float) -> None:
    laid = path(*THREE)
    step = 1e-6
    slope = (laid.position([s + step]) - laid.position([s - step])) / (2 * step)
    np.testing.assert_allclose(laid.tangent([s]), slope, atol=3 * step / laid.radii.min())


@given(st.floats(-3, 3))
def test_arc_length_is_periodic(s: float) -> None:
    laid = path(*THREE)
    np.testing.assert_allclose(laid.position([s]), laid.position([s + laid.length]), atol=1e-12)


@given(angle=ANGLES, x=SHIFTS, y=SHIFTS)
def test_the_path_moves_with_its_pulleys(angle: float, x: float, y: float) -> None:
    laid = path(*THREE)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    moved = Path(laid.centers @ turn.T + [x, y], laid.radii)
    s = np.linspace(0.01, laid.length - 0.01, 50)
    assert moved.length == pytest.approx(laid.length)
    np.testing.assert_allclose(moved.wrap_angles, laid.wrap_angles, atol=1e-12)
    np.testing.assert_allclose(moved.position(s), laid.position(s) @ turn.T + [x, y], atol=1e-12)
    np.testing.assert_allclose(moved.tangent(s), laid.tangent(s) @ turn.T, atol=1e-10)


def test_no_tangent() -> None:
    with pytest.raises(ValueError, match="no common tangent"):
        path((0, 0, 0.5), (0.1, 0, 0.1))


SERPENTINE = (
    (0.0, 0.0, 0.082),
    (0.22, -0.06, 0.062),
    (0.26, 0.16, 0.032),
    (0.11, 0.16, -0.038),
    (0.08, 0.33, 0.062),
    (-0.03, 0.17, -0.053),
    (-0.17, 0.07, 0.037),
)
IDLER = ((0.0, 0.0, 0.1), (0.25, -0.05, -0.04), (0.8, 0.0, 0.2))
CROSSED = ((0.0, 0.0, 0.12), (0.6, 0.0, -0.08))
LAYOUTS = pytest.mark.parametrize("circles", [THREE, IDLER, CROSSED, SERPENTINE])


def test_crossed_belt_by_hand() -> None:
    """2 D cos b + (R + r)(pi + 2 b), sin b = (R + r) / D."""
    laid = path(*CROSSED)
    beta = math.asin(0.2 / 0.6)
    assert laid.length == pytest.approx(2 * 0.6 * math.cos(beta) + 0.2 * (math.pi + 2 * beta), rel=1e-15)


def test_idler_on_the_back_by_hand() -> None:
    """Equal pulleys, the idler in the middle: its inner tangents climb by arcsin of radii over distance."""
    radius, idler, half, depth = 0.1, 0.04, 0.4, 0.06
    laid = path((-half, 0, radius), (0, -radius - idler + depth, -idler), (half, 0, radius))
    center = math.atan2(-radius - idler + depth, half)
    distance = math.hypot(half, radius + idler - depth)
    climb = center + math.asin((radius + idler) / distance)
    span = math.sqrt(distance**2 - (radius + idler) ** 2)
    np.testing.assert_allclose(laid.wrap_angles, [math.pi + climb, 2 * climb, math.pi + climb], rtol=1e-14)
    np.testing.assert_allclose(laid.span_lengths, [span, span, 2 * half], rtol=1e-14)
    expected = 2 * span + 2 * half + 2 * radius * (math.pi + climb) + idler * 2 * climb
    assert laid.length == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("circles", [THREE, IDLER, SERPENTINE])
def test_a_round_without_crossing_turns_once(circles: tuple[tuple[float, float, float], ...]) -> None:
    assert path(*circles).total_turning == pytest.approx(2 * math.pi, abs=1e-14)


@LAYOUTS
@given(angle=ANGLES, x=SHIFTS, y=SHIFTS, scale=st.floats(0.1, 10), first=st.integers(0, 6))
def test_rotated_shifted_scaled_relabelled(
    circles: tuple[tuple[float, float, float], ...], angle: float, x: float, y: float, scale: float, first: int
) -> None:
    laid = path(*circles)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    centers = np.roll(laid.centers @ turn.T * scale + [x, y], first, axis=0)
    moved = Path(centers, np.roll(laid.radii * scale, first))
    np.testing.assert_allclose(moved.wrap_angles, np.roll(laid.wrap_angles, first), atol=1e-10)
    np.testing.assert_allclose(moved.span_lengths, scale * np.roll(laid.span_lengths, first), atol=1e-12)
    assert moved.length == pytest.approx(scale * laid.length, rel=1e-11)


@LAYOUTS
def test_mirrored_and_run_in_reverse(circles: tuple[tuple[float, float, float], ...]) -> None:
    """The mirror turns left into right, the reversed order back: the sides stay."""
    laid = path(*circles)
    mirrored = Path((laid.centers * [-1, 1])[::-1], laid.radii[::-1])
    np.testing.assert_allclose(mirrored.wrap_angles, laid.wrap_angles[::-1], atol=1e-14)
    np.testing.assert_allclose(mirrored.span_lengths, np.roll(laid.span_lengths[::-1], -1), rtol=1e-14)
    s = np.linspace(0.0, laid.length, 60)
    backwards = laid.position(laid.length - s) * [-1, 1]
    shift = _closest(mirrored, backwards[0])
    np.testing.assert_allclose(mirrored.position(s + shift), backwards, atol=1e-6)


def _closest(laid: Path, point: np.ndarray) -> float:
    """Arc length of the point on a path that is closest to another."""
    s = np.linspace(0.0, laid.length, 20001)
    near = s[np.argmin(np.linalg.norm(laid.position(s) - point, axis=1))]
    step = laid.position([near])[0] - point
    return float(near - step @ laid.tangent([near])[0])


@LAYOUTS
def test_moving_a_pulley_lengthens_the_path_along_its_spans(circles: tuple[tuple[float, float, float], ...]) -> None:
    """dL/dc = u_in - u_out, against central differences (their error is of the order of step^2 / R^2)."""
    laid, step = path(*circles), 1e-5
    for pulley in range(laid.count):
        for axis in range(2):
            lengths = []
            for sign in (1, -1):
                centers = laid.centers.copy()
                centers[pulley, axis] += sign * step
                lengths.append(Path(centers, laid.radii).length)
            slope = (lengths[0] - lengths[1]) / (2 * step)
            expected = laid.span_directions[pulley - 1] - laid.span_directions[pulley]
            assert slope == pytest.approx(expected[axis], abs=1e-7)


def open_path() -> Path:
    """From an end over a pulley, counter-clockwise, under a second one, clockwise, to the other end."""
    return Path(np.array([[0.0, 0.0], [-0.5, 0.3]]), np.array([0.1, -0.05]), np.array([[0.1, -0.4], [-0.6, 0.9]]))


def test_over_one_pulley_from_end_to_end() -> None:
    """Up on the right, half a turn over the pulley, down on the left: the last span is the first along the path."""
    laid = Path(np.zeros((1, 2)), np.array([0.1]), np.array([[0.1, -0.4], [-0.1, -0.3]]))
    assert (laid.count, laid.spans) == (1, 2)
    np.testing.assert_allclose(laid.span_lengths, [0.3, 0.4])
    np.testing.assert_allclose(laid.span_directions, [[0, -1], [0, 1]], atol=1e-15)
    np.testing.assert_allclose(laid.ways_out, [[0, -1], [0, -1]], atol=1e-15)
    np.testing.assert_allclose(laid.wrap_angles, [math.pi])
    assert laid.length == pytest.approx(0.7 + 0.1 * math.pi)
    places = laid.position(np.array([0.0, 0.4, 0.4 + 0.05 * math.pi, laid.length, laid.length + 1.0, -1.0]))
    ends = [[0.1, -0.4], [0.1, 0.0], [0.0, 0.1], [-0.1, -0.3], [-0.1, -0.3], [0.1, -0.4]]
    np.testing.assert_allclose(places, ends, atol=1e-15)


def test_an_open_path_is_smooth_and_as_long_as_it_says() -> None:
    laid = open_path()
    s = np.linspace(0.0, laid.length, 20_001)
    places, tangents, step = laid.position(s), laid.tangent(s), s[1]
    np.testing.assert_allclose(np.linalg.norm(np.diff(places, axis=0), axis=1), step, rtol=1e-6)
    np.testing.assert_allclose(np.diff(places, axis=0) / step, tangents[:-1], atol=step / 0.05)
    np.testing.assert_allclose(places[[0, -1]], [[0.1, -0.4], [-0.6, 0.9]], atol=1e-15)
    bends = laid.bend(s)
    reach = np.linalg.norm(bends, axis=1)
    assert set(np.round(reach, 9)) == {0.0, 10.0, 20.0}
    turned = tangents[:, 0] * bends[:, 1] - tangents[:, 1] * bends[:, 0]
    assert np.trapezoid(turned, s) == pytest.approx(laid.total_turning, abs=3 * step * 20)


def test_an_open_path_needs_no_way_back_from_end_to_end() -> None:
    """Both ends at one point, as those of a strap on one lever."""
    laid = Path(np.zeros((1, 2)), np.array([0.1]), np.array([[0.0, -0.2], [0.0, -0.2]]))
    np.testing.assert_allclose(laid.span_lengths, math.sqrt(0.2**2 - 0.1**2))
    np.testing.assert_allclose(laid.wrap_angles, 2 * math.pi - 2 * math.acos(0.5))


@pytest.mark.parametrize("pulley", [0, 1])
def test_gradient_of_an_open_path(pulley: int) -> None:
    laid, step = open_path(), 1e-6
    for axis in (0, 1):
        change = np.zeros((2, 2))
        change[pulley, axis] = step
        ahead, behind = (Path(laid.centers + sign * change, laid.radii, laid.ends).length for sign in (1, -1))
        assert laid.gradient(pulley)[axis] == pytest.approx((ahead - behind) / (2 * step), abs=1e-9)


def test_names_have_room_where_no_span_runs() -> None:
    """Beyond the arc of a pulley; a path that does not bend has no such side."""
    line = Path(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([0.1, 0.1]))
    assert line.clear_way(0) == pytest.approx((-1.0, 0.0))
    assert line.clear_way(1) == pytest.approx((1.0, 0.0))

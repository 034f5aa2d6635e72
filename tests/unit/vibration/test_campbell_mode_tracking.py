"""Modes are followed by their shapes: through crossings, gaps, and beginnings."""

import numpy as np
import pytest

from beltdyn.arrays import ComplexArray
from beltdyn.vibration.campbell import SeenModes, Tracks, assurance
from beltdyn.vibration.mode_shapes import Shares


def seen(frequencies: list[float], shapes: list[list[complex]]) -> SeenModes:
    """Modes with as much energy in the first span as their frequency says."""
    speeds = np.array([np.array(one) / np.linalg.norm(one) for one in shapes], complex)
    own = np.array(frequencies)
    shares = Shares(own[:, None], 0.0 * own[:, None], 0.0 * own, np.zeros((own.size, 0)))
    return SeenModes(-0.1 + 1j * own, speeds, shares)


def angular(tracks: Tracks, states: int) -> list[list[float]]:
    """Angular frequencies, zero where a mode is not found."""
    values: ComplexArray = tracks.table(states).values
    return [[float(one) for one in row] for row in np.nan_to_num(values.imag)]


def test_assurance() -> None:
    """One of a shape with itself, at any phase; none without common motion; a half between."""
    first, second = np.eye(2, dtype=complex)
    shapes = np.array([first, second])
    others = np.array([np.exp(0.7j) * first, (first + 1j * second) / np.sqrt(2.0)])
    np.testing.assert_allclose(assurance(shapes, others), [[1.0, 0.5], [0.0, 0.5]], atol=1e-15)


def test_modes_that_cross_keep_their_columns() -> None:
    tracks = Tracks(2)
    tracks.take(seen([1.0, 2.0], [[1, 0], [0, 1]]))
    tracks.take(seen([1.4, 1.5], [[0.1, 1], [1, -0.1]]))
    tracks.take(seen([1.2, 1.8], [[0, 1], [1j, 0]]))
    assert angular(tracks, 3) == [[1.0, 2.0], [1.5, 1.4], [1.8, 1.2]]
    found = tracks.table(3)
    assert np.isnan(found.assurance[0]).all()
    assert found.assurance[1:].min() > 0.9
    assert found.mean_shares(0).span == pytest.approx((1.0 + 1.5 + 1.8) / 3.0)
    np.testing.assert_allclose(found.damping_ratio[0, 0], 0.1 / np.hypot(1.0, 0.1))


def test_a_mode_goes_on_behind_a_gap() -> None:
    tracks = Tracks(2)
    tracks.take(seen([1.0, 2.0], [[1, 0], [0, 1]]))
    tracks.take(None)
    tracks.take(seen([1.1], [[1, 0]]))
    assert angular(tracks, 4) == [[1.0, 2.0], [0.0, 0.0], [1.1, 0.0], [0.0, 0.0]]


def test_what_agrees_with_none_begins_a_column_and_high_modes_are_left_out() -> None:
    tracks = Tracks(1)
    tracks.take(seen([1.0, 3.0], [[1, 0, 0], [0, 1, 0]]))
    tracks.take(seen([0.5, 1.0], [[0, 0, 1], [1, 0, 0]]))
    assert angular(tracks, 2) == [[1.0, 0.0], [1.0, 0.5]]


@pytest.mark.parametrize(("before", "after"), [(1.0, 10.0), (1.0, 3.5), (3.5, 1.0)])
def test_a_shape_alone_does_not_make_it_another_mode(before: float, after: float) -> None:
    """Of more than three times the frequency, or less than a third, it is another one."""
    tracks = Tracks(1)
    tracks.take(seen([before], [[1, 0]]))
    tracks.take(seen([after], [[1, 0]]))
    assert angular(tracks, 2) == [[before, 0.0], [0.0, after]]


def test_modes_are_followed_while_their_shapes_turn() -> None:
    """By 40 degrees from state to state: in the third each is nearer to what the other was."""
    tracks = Tracks(2)
    for state in range(3):
        cosine, sine = np.cos(state * np.radians(40.0)), np.sin(state * np.radians(40.0))
        tracks.take(seen([1.0, 1.1], [[cosine, sine], [-sine, cosine]]))
    assert angular(tracks, 3) == [[1.0, 1.1]] * 3
    np.testing.assert_allclose(tracks.table(3).assurance[1:], np.cos(np.radians(40.0)) ** 2)


def test_behind_a_state_without_it_a_mode_must_agree_better() -> None:
    """A square of 0.6 of the cosine: 40 degrees are too many."""
    tracks, turned = Tracks(2), np.radians(40.0)
    tracks.take(seen([1.0], [[1, 0, 0]]))
    tracks.take(seen([1.1], [[0, 0, 1]]))
    tracks.take(seen([1.0], [[np.cos(turned), np.sin(turned), 0]]))
    assert angular(tracks, 3) == [[1.0, 0.0, 0.0], [0.0, 1.1, 0.0], [0.0, 0.0, 1.0]]


def test_heavily_damped_modes_do_not_count_and_come_last() -> None:
    """Two creeping motions below two vibrations: with two modes requested all four are there, creeping ones last."""
    values = np.array([-3.0 + 1.0j, -8.0 + 2.0j, -0.1 + 5.0j, -0.2 + 9.0j, -0.3 + 12.0j])
    tracks = Tracks(2)
    for _ in range(2):
        tracks.take(seen([1.0, 2.0, 5.0, 9.0, 12.0], np.eye(5, dtype=complex).tolist())._replace(values=values))
    assert angular(tracks, 2) == [[5.0, 9.0, 1.0, 2.0]] * 2

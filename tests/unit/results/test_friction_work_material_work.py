"""Work of friction handed on from pieces of the mesh to the belt that was there."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.results.friction_work import MaterialWork

LENGTHS = np.array([0.1, 0.3, 0.2, 0.4])


def on_belt(by_mesh: list[float], *passed: float) -> np.ndarray:
    """Work on the belt after the last of several states, in which work grows evenly with the way of the belt."""
    parts = np.asarray(passed) / passed[-1] if passed[-1] else np.ones(len(passed))
    work = parts[:, None, None] * np.array(by_mesh)[None, None]
    return np.asarray(MaterialWork(LENGTHS).take(work, at_pieces(np.asarray(passed)))[-1, 0])


def at_pieces(passed: FloatArray) -> FloatArray:
    """The same length has passed everywhere."""
    return np.repeat(passed[:, None], LENGTHS.size, axis=1)


def test_a_belt_that_stands_keeps_the_work_where_it_is_done() -> None:
    np.testing.assert_allclose(on_belt([1.0, 2.0, 0.0, 3.0], 0.0), [1.0, 2.0, 0.0, 3.0], atol=1e-7)


@pytest.mark.parametrize("way", [0.05, 0.35, -0.35, 0.95, 1.0, 1.7, -2.3, 12.4])
def test_no_work_is_lost(way: float) -> None:
    assert on_belt([1.0, 2.0, 0.5, 3.0], way).sum() == pytest.approx(6.5, rel=1e-9)


@pytest.mark.parametrize("turns", [1, 2, -3])
def test_whole_turns_spread_it_evenly(turns: int) -> None:
    np.testing.assert_allclose(on_belt([0.0, 2.0, 0.0, 0.0], turns * 1.0), 2.0 * LENGTHS, rtol=1e-7)


@pytest.mark.parametrize("way", [0.07, 0.42, -0.61, 1.3])
def test_it_falls_on_what_passes(way: float) -> None:
    """Against a count of many points of the piece at many instants."""
    a, b = 0.1, 0.4
    places, instants = np.meshgrid(np.linspace(a, b, 1501), np.linspace(0.0, way, 1501))
    belt = (places - instants) % 1.0
    counted = np.histogram(belt, np.concatenate([[0.0], np.cumsum(LENGTHS)]))[0] / belt.size
    np.testing.assert_allclose(on_belt([0.0, 1.0, 0.0, 0.0], way), counted, atol=2e-3)


def test_states_one_after_another_are_as_good_as_at_once() -> None:
    """The places of the belt go on from state to state, and from one call to the next."""
    rule, ways = MaterialWork(LENGTHS), at_pieces(np.array([0.13, 0.5, 0.71, 1.2]))
    work = ways[:, None] * np.array([0.3, 1.0, 0.0, 0.2])
    parts = np.concatenate([rule.take(work[:2], ways[:2]), rule.take(work[2:], ways[2:])])
    np.testing.assert_allclose(parts, MaterialWork(LENGTHS).take(work, ways), rtol=1e-12)
    np.testing.assert_allclose(parts[-1, 0], on_belt([0.36, 1.2, 0.0, 0.24], 1.2), rtol=1e-9)


def test_pieces_at_which_other_lengths_have_passed() -> None:
    """The belt of an axis goes past one pulley only: work there falls on what passes, work elsewhere stays in place."""
    work = np.array([[[0.0, 1.0, 0.0, 2.0]]])
    found = MaterialWork(LENGTHS).take(work, np.array([[0.0, 0.05, 0.0, 0.0]]))[0, 0]
    passing, standing = on_belt([0.0, 1.0, 0.0, 0.0], 0.05), on_belt([0.0, 0.0, 0.0, 2.0], 0.0)
    np.testing.assert_allclose(found, passing + standing, atol=1e-7)

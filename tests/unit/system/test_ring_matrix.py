"""The O(n) solver against LAPACK's dense one (numpy.linalg.solve)."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.arrays import FloatArray
from beltdyn.system.arrays import RingMatrix
from beltdyn.system.ring_matrix import (
    clear,
    determinant_sign,
    entries,
    hold_at_end,
    places,
    ring_matrix,
    solve_ring,
    substitute,
)

Dense = Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]]
PARTS = ("diagonal", "upper", "lower", "column", "row", "corner", "node_side", "border_side")


def random_ring(nodes: int, border: int, seed: int, dof: int = 6) -> RingMatrix:
    """Random blocks with diagonals heavy enough for a condition number below 1e3."""
    ring, random = ring_matrix(dof, nodes, border), np.random.default_rng(seed)
    for name in PARTS:
        part = getattr(ring, name)
        part[:] = random.normal(size=part.shape)
    ring.diagonal[:] += 20.0 * np.eye(dof)
    ring.corner[:] += 20.0 * np.eye(border)
    return ring


def solution(ring: RingMatrix, closed: bool) -> FloatArray:
    node_part, border_part = np.empty_like(ring.node_side), np.empty_like(ring.border_side)
    assert solve_ring(ring, closed, node_part, border_part)
    return np.concatenate([node_part.ravel(), border_part])


@pytest.mark.parametrize("dof", [4, *(pytest.param(one, marks=pytest.mark.slow) for one in (2, 6, 8))])
@given(st.integers(3, 12), st.integers(0, 10), st.booleans(), st.integers(0, 2**32 - 1))
def test_solves_what_lapack_solves(dense: Dense, dof: int, nodes: int, border: int, closed: bool, seed: int) -> None:
    ring = random_ring(nodes, border, seed, dof)
    expected = np.linalg.solve(*dense(ring, closed))
    np.testing.assert_allclose(solution(ring, closed), expected, atol=1e-12)  # rounding times the condition number


@given(st.integers(3, 8), st.integers(0, 6), st.booleans(), st.integers(0, 2**32 - 1))
def test_the_sign_of_the_determinant(dense: Dense, nodes: int, border: int, closed: bool, seed: int) -> None:
    ring = random_ring(nodes, border, seed)
    ring.diagonal[:] -= 20.0 * np.eye(6)  # half of all signs are negative then
    solution(ring, closed)
    assert determinant_sign(ring, closed) == np.linalg.slogdet(dense(ring, closed)[0])[0]


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
def test_long_rings(dense: Dense, closed: bool) -> None:
    ring = random_ring(300, 2, 0)
    np.testing.assert_allclose(solution(ring, closed), np.linalg.solve(*dense(ring, closed)), atol=1e-12)


@pytest.mark.parametrize("node", [0, 4])
def test_a_coordinate_that_is_held_at_an_end_keeps_to_itself(dense: Dense, node: int) -> None:
    ring = random_ring(5, 3, 6)
    before = dense(ring, False)[0].copy()
    hold_at_end(ring, node, 1)
    after, place = dense(ring, False)[0], 6 * node + 1
    unit = np.eye(len(after))[place]
    np.testing.assert_array_equal(after[place], unit)
    np.testing.assert_array_equal(after[:, place], unit)
    others = np.arange(len(after)) != place
    np.testing.assert_array_equal(after[others][:, others], before[others][:, others])


def test_keeps_the_matrix() -> None:
    ring, same = random_ring(5, 3, 4), random_ring(5, 3, 4)
    solution(ring, True)
    for name in PARTS:
        np.testing.assert_array_equal(getattr(ring, name), getattr(same, name))


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
def test_factors_serve_other_right_hand_sides(dense: Dense, closed: bool) -> None:
    ring, other = random_ring(7, 3, 9), random_ring(7, 3, 10)
    solution(ring, closed)
    ring.node_side[:], ring.border_side[:] = other.node_side, other.border_side
    node_part, border_part = np.empty_like(ring.node_side), np.empty_like(ring.border_side)
    substitute(ring, closed, node_part, border_part)
    found = np.concatenate([node_part.ravel(), border_part])
    np.testing.assert_allclose(found, np.linalg.solve(*dense(ring, closed)), atol=1e-12)


def test_pivots_within_blocks(dense: Dense) -> None:
    ring = random_ring(4, 1, 5)
    ring.diagonal[:] = ring.diagonal[:, ::-1]
    np.testing.assert_allclose(solution(ring, True), np.linalg.solve(*dense(ring, True)), atol=1e-11)


def test_blocks_without_a_diagonal_are_solved(dense: Dense) -> None:
    """Both rows of each block have to change places."""
    ring = random_ring(4, 1, 5, dof=2)
    ring.diagonal[:] = ring.diagonal[:, ::-1]
    ring.diagonal[:, [0, 1], [0, 1]] = 0.0
    np.testing.assert_allclose(solution(ring, True), np.linalg.solve(*dense(ring, True)), atol=1e-11)


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
@pytest.mark.parametrize("place", ["node", "last node", "border"])
def test_singular_matrix_is_refused(closed: bool, place: str) -> None:
    ring = random_ring(4, 2, 6)
    node = {"node": 1, "last node": 3}.get(place)
    if node is None:
        ring.corner[0], ring.row[:, 0] = 0.0, 0.0
    else:
        ring.diagonal[node, 2] = ring.upper[node, 2] = ring.lower[node - 1, 2] = ring.column[node, 2] = 0.0
    assert not solve_ring(ring, closed, np.empty((4, 6)), np.empty(2))


def test_nan_is_refused() -> None:
    ring = random_ring(4, 0, 7)
    ring.diagonal[0, 0, 0] = np.nan
    assert not solve_ring(ring, True, np.empty((4, 6)), np.empty(0))


@pytest.mark.parametrize("nodes", [3, 8])
@pytest.mark.parametrize("border", [0, 3])
def test_entries_and_their_places(dense: Dense, nodes: int, border: int) -> None:
    ring = random_ring(nodes, border, 11)
    expected = dense(ring, True)[0]
    found = np.zeros_like(expected)
    np.add.at(found, places(ring), entries(ring))
    np.testing.assert_array_equal(found, expected)


def test_clear() -> None:
    ring = random_ring(3, 2, 8)
    clear(ring, False)
    assert [name for name in PARTS if not np.any(getattr(ring, name))] == ["node_side", "border_side"]
    clear(ring, True)
    assert not any(np.any(getattr(ring, name)) for name in PARTS)

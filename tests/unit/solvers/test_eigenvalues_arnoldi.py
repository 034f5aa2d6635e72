"""The Arnoldi method against all eigenvalues."""

import numpy as np

from beltdyn.solvers.eigenvalues import arnoldi


def test_the_largest_eigenvalues_of_a_map() -> None:
    given = np.random.default_rng(1).standard_normal((120, 120))
    expected = np.linalg.eigvals(given)
    *_, last = arnoldi(lambda vector: given @ vector, 120, 9)
    np.testing.assert_allclose(np.sort(np.abs(last.values))[::-1], np.sort(np.abs(expected))[::-1], rtol=1e-8)
    vectors = last.vectors(5)
    np.testing.assert_allclose(given @ vectors, vectors * last.values[:5], atol=1e-8)
    assert last.residuals[:5].max() < 1e-8


def test_residuals_bound_the_errors_of_a_symmetric_map() -> None:
    given = np.diag(np.arange(1.0, 201.0))
    first = next(arnoldi(lambda vector: given @ vector, 200, 1))
    away = np.min(np.abs(first.values[:, None] - np.diag(given)), axis=1)
    assert np.all(away <= first.residuals * np.abs(first.values) * (1.0 + 1e-9))
    assert first.residuals.max() > 1e-3


def test_steps_end_with_the_size() -> None:
    given = np.diag([3.0, -2.0, 1.0])
    *_, last = arnoldi(lambda vector: given @ vector, 3, 4)
    np.testing.assert_allclose(last.values, [3.0, -2.0, 1.0], atol=1e-12)


def test_a_map_that_fails_gives_nothing() -> None:
    assert list(arnoldi(lambda vector: vector * np.nan, 50, 2)) == []

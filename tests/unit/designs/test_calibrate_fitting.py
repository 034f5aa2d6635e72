"""Fits of numbers, and how often their intervals hold the true ones."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy import stats

from beltdyn.arrays import FloatArray
from beltdyn.designs.calibrate import fit

ROWS = np.linspace(0.0, 1.0, 12)
TRUE = np.array([0.4, 0.6])
DEVIATION = 0.02


def model(x: FloatArray) -> FloatArray:
    """A curve that is a little bent in one number."""
    return np.asarray(x[0] * ROWS + np.exp(-x[1] * ROWS))


def slopes(x: FloatArray) -> FloatArray:
    return np.column_stack([ROWS, -ROWS * np.exp(-x[1] * ROWS)])


def straight(rows: FloatArray, measured: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Residuals of a straight model."""
    return lambda x: np.asarray(rows @ x - measured)


def constant(rows: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Derivatives of a straight model."""
    return lambda _: rows


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("confidence", [0.6827, 0.95])
def test_coverage(known: bool, confidence: float) -> None:
    """Of 400 fits to noise, as many intervals hold the true numbers as they say, within three deviations of that."""
    rng, fits = np.random.default_rng(1), 400
    scale = DEVIATION if known else 1.0
    held = np.zeros(2)
    rows = np.column_stack([ROWS, 1.0 + 0.0 * ROWS])
    for _ in range(fits):
        noisy = rows @ TRUE + DEVIATION * rng.standard_normal(ROWS.size)
        start = np.array([0.5, 0.5])
        found = fit(straight(rows / scale, noisy / scale), lambda _: rows / scale, start, confidence, known=known)
        held += np.abs(found.numbers - TRUE) <= found.reach * found.errors
    allowed = 3.0 * np.sqrt(confidence * (1.0 - confidence) / fits)
    assert held / fits == pytest.approx(confidence, abs=allowed)


def test_without_noise_the_numbers_are_found() -> None:
    exact = model(TRUE)
    found = fit(lambda x: model(x) - exact, slopes, np.array([0.1, 0.9]), 0.95, known=False)
    np.testing.assert_allclose(found.numbers, TRUE, atol=1e-6)
    assert found.told
    assert found.spread < 1e-6


def test_errors_are_those_of_the_normal_equations() -> None:
    """For straight residuals: covariance (J'J)^-1."""
    jacobian = np.column_stack([ROWS, np.ones(ROWS.size)]) / DEVIATION
    found = fit(lambda x: jacobian @ (x - TRUE), lambda x: jacobian, np.array([0.5, 0.5]), 0.95, known=True)
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    np.testing.assert_allclose(found.errors, np.sqrt(np.diag(covariance)), rtol=1e-8)
    assert found.correlation[0, 1] == pytest.approx(covariance[0, 1] / np.sqrt(np.prod(np.diag(covariance))))
    assert found.reach == pytest.approx(1.959964, rel=1e-6)


@pytest.mark.parametrize("known", [True, False])
def test_numbers_in_other_units_have_errors_in_those(known: bool) -> None:
    """Columns of any size, among them that of one, are told as well; with deviations known errors are their inverse."""
    rng = np.random.default_rng(4)
    alike = np.linalg.qr(rng.normal(size=(ROWS.size, 3)))[0]
    alike /= np.linalg.norm(alike, axis=0)
    noise = 0.1 * rng.normal(size=ROWS.size)
    for scales in (np.ones(3), np.array([1e-9, 1.0, 1e6])):
        jacobian = alike * scales
        residuals, start = straight(jacobian, 0.5 * jacobian.sum(axis=1) + noise), np.full(3, 0.5)
        found = fit(residuals, constant(jacobian), start, 0.95, known=known)
        assert found.told
        factor = 1.0 if known else found.spread
        np.testing.assert_allclose(found.errors * scales, factor, rtol=1e-6)
        np.testing.assert_allclose(found.correlation, np.eye(3), atol=1e-9)
        reach = stats.norm.ppf(0.975) if known else stats.t.ppf(0.975, ROWS.size - 3)
        assert found.reach == pytest.approx(reach)


def test_numbers_that_cannot_be_told_apart() -> None:
    jacobian = np.column_stack([ROWS, 2.0 * ROWS])
    found = fit(lambda x: jacobian @ (x - TRUE), lambda x: jacobian, np.array([0.5, 0.5]), 0.95, known=True)
    assert found.untold == (0, 1)
    assert not found.told
    assert np.all(np.isinf(found.errors))


def test_a_number_that_changes_nothing_is_named() -> None:
    jacobian = np.column_stack([ROWS, 0.0 * ROWS, np.ones(ROWS.size)])
    true = np.array([0.4, 0.5, 0.6])
    found = fit(lambda x: jacobian @ (x - true), lambda x: jacobian, np.full(3, 0.5), 0.95, known=True)
    assert found.untold == (1,)


def test_derivatives_with_errors_do_not_tell_apart_what_is_alike() -> None:
    """Derivatives are exact to 1e-5, so that two columns alike differ by as much."""
    noise = 1e-6 * np.random.default_rng(5).standard_normal(ROWS.size)
    jacobian = np.column_stack([ROWS, 2.0 * ROWS + noise, np.ones(ROWS.size)])
    true = np.array([0.4, 0.5, 0.6])
    found = fit(lambda x: jacobian @ (x - true), lambda x: jacobian, np.full(3, 0.5), 0.95, known=True)
    assert found.untold == (0, 1)


@pytest.mark.parametrize("calls", [1, 2, 3, 4])
def test_an_interrupted_search_keeps_what_it_has_come_to(calls: int) -> None:
    """The numbers are nearer than the start, with their own residuals and derivatives; not before there are any."""
    exact, start, count = model(TRUE), np.array([0.1, 0.9]), 0

    def residuals(x: FloatArray) -> FloatArray:
        nonlocal count
        count += 1
        if count > calls:
            raise KeyboardInterrupt
        return model(x) - exact

    if calls == 1:
        with pytest.raises(KeyboardInterrupt):
            fit(residuals, slopes, start, 0.95, known=False)
        return
    found = fit(residuals, slopes, start, 0.95, known=False)
    assert found.interrupted
    np.testing.assert_array_equal(found.residuals, model(found.numbers) - exact)
    assert (found.residuals**2).sum() <= ((model(start) - exact) ** 2).sum()
    assert np.all(np.isfinite(found.errors))

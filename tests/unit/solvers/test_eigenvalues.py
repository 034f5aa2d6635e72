"""Eigenvalues of small systems in closed form, and of large ones against all of them at once."""

import numpy as np
import pytest
from scipy.sparse import csc_array

from beltdyn.arrays import FloatArray
from beltdyn.solvers import eigenvalues
from beltdyn.solvers import eigenvalues as arnoldi
from beltdyn.solvers.eigenvalues import all_eigenvalues, lightly_damped, nearest, pencil, swinging, swings

Matrices = tuple[csc_array, csc_array, csc_array]


def chain(count: int, damping: float = 0.0, turning: float = 0.0) -> Matrices:
    """Masses of 1 kg in a row on springs of 1e6 N/m from wall to wall, damped, with gyroscopic forces."""
    row = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    gyroscopic = turning * (np.eye(count, k=1) - np.eye(count, k=-1))
    return csc_array(1e6 * row), csc_array(damping * row + gyroscopic), csc_array(np.eye(count))


def none(count: int) -> FloatArray:
    return np.zeros((count, 0))


def test_a_damped_oscillator() -> None:
    stiffness, damping, mass = (csc_array(np.array([[value]])) for value in (400.0, 4.0, 1.0))
    given = pencil(stiffness, damping, mass, none(1))
    values, vectors = swinging(given, 3)
    assert values == pytest.approx([-2.0 + 1j * np.sqrt(396.0)])
    assert given.coordinates(values, vectors).shape == (1, 1)


@pytest.mark.parametrize("count", [20, 300])
def test_a_chain_has_its_frequencies(count: int) -> None:
    values, vectors = swinging(pencil(*chain(count), none(count)), 15)
    number = np.arange(1, 16)
    expected = 2e3 * np.sin(0.5 * np.pi * number / (count + 1))
    np.testing.assert_allclose(values.imag, expected, rtol=1e-7)
    assert np.abs(values.real).max() < 1e-6 * expected.max()
    shapes = pencil(*chain(count), none(count)).coordinates(values, vectors)
    wave = np.sin(np.pi * np.outer(np.arange(1, count + 1), number) / (count + 1))
    np.testing.assert_allclose(np.abs(shapes / np.abs(shapes).max(axis=0)), np.abs(wave / wave.max(axis=0)), atol=2e-2)


def test_bands_leave_out_nothing() -> None:
    given = pencil(*chain(120, damping=30.0, turning=120.0), none(120))
    expected = all_eigenvalues(given)[0]
    expected = np.sort_complex(1j * expected[swings(expected)].conj())[:40]
    found = swinging(given, 40)[0]
    assert found.size == 40
    assert np.all(np.diff(found.imag) > 0.0)
    np.testing.assert_allclose(np.sort_complex(1j * found.conj()), expected, rtol=1e-6)


def test_eigenvalues_come_in_conjugate_pairs() -> None:
    values = all_eigenvalues(pencil(*chain(30, damping=30.0, turning=120.0), none(30)))[0]
    assert values.size == 60
    away = np.min(np.abs(values[:, None] - values.conj()), axis=1)
    assert away.max() < 1e-8 * np.abs(values).max()


def test_what_turns_freely_is_no_mode() -> None:
    """Two discs on a shaft that turns freely swing against each other; no eigenvalue pair of zero is left."""
    stiffness = csc_array(900.0 * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    mass = csc_array(np.diag([1.0, 2.0]))
    together = np.ones((2, 1))
    given = pencil(stiffness, csc_array((2, 2)), mass, together)
    values, vectors = all_eigenvalues(given)
    assert given.size == 3
    assert sorted(values.imag) == pytest.approx([-np.sqrt(1350.0), 0.0, np.sqrt(1350.0)])
    number = int(np.argmax(values.imag))
    shape = given.coordinates(values[[number]], vectors[:, [number]])[:, 0]
    assert shape[0] / shape[1] == pytest.approx(-2.0)


def test_constraints_give_no_modes() -> None:
    """A mass on a spring, and a second one that a multiplier ties to it."""
    stiffness = csc_array(np.array([[800.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, -1.0, 0.0]]))
    mass = csc_array(np.diag([1.0, 1.0, 0.0]))
    values = swinging(pencil(stiffness, csc_array((3, 3)), mass, none(3)), 9)[0]
    assert values == pytest.approx([20j])


@pytest.mark.slow
def test_nearest_to_a_shift() -> None:
    given = pencil(*chain(300), none(300))
    values, vectors = nearest(given, 500j, 12)
    expected = all_eigenvalues(given)[0]
    distance = np.sort(np.abs(expected - 500j))
    np.testing.assert_allclose(np.abs(values - 500j)[:12], distance[:12], rtol=1e-6)
    by_state = given.by_state.toarray() @ vectors
    by_rate = given.by_rate.toarray() @ vectors
    assert np.abs(by_state - by_rate * values).max() < 1e-5 * np.abs(by_state).max()


def test_all_of_a_small_large_system(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(eigenvalues, "_SMALL", 0)
    values = swinging(pencil(*chain(12), none(12)), 99)[0]
    np.testing.assert_allclose(values.imag, 2e3 * np.sin(0.5 * np.pi * np.arange(1, 13) / 13), rtol=1e-7)


def oscillators(count: int) -> tuple[Matrices, FloatArray, FloatArray]:
    """Masses of 1 kg, each on its own: matrices, natural frequencies (rad/s) and damping ratios from 0 to 1.3."""
    random = np.random.default_rng(7)
    own, ratio = np.exp(random.uniform(np.log(20.0), np.log(5e3), count)), random.uniform(0.0, 1.3, count)
    matrices = csc_array(np.diag(own**2)), csc_array(np.diag(2.0 * ratio * own)), csc_array(np.eye(count))
    return matrices, own, ratio


@pytest.mark.parametrize("batch", [30, 40, 60])
@pytest.mark.parametrize("count", [5, pytest.param(20, marks=pytest.mark.slow)])
def test_which_modes_are_given_is_a_rule(batch: int, count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those damped by less than 0.9, and no others, up to the last lightly damped one, whatever finds them."""
    monkeypatch.setattr(arnoldi, "_BATCH", batch)
    matrices, own, ratio = oscillators(120)
    swing = ratio < eigenvalues.MOST_DAMPED
    expected = own[swing] * (-ratio[swing] + 1j * np.sqrt(1.0 - ratio[swing] ** 2))
    last = np.sort(expected.imag[lightly_damped(expected)])[count - 1]
    expected = expected[expected.imag <= last * (1.0 + 1e-9)]
    found = swinging(pencil(*matrices, none(120)), count, counted=lightly_damped)[0]
    assert found.size == expected.size > count
    np.testing.assert_allclose(found, expected[np.argsort(expected.imag)], rtol=1e-6)


@pytest.mark.slow
def test_a_search_that_begins_elsewhere_gives_the_same_modes() -> None:
    given = pencil(*oscillators(120)[0], none(120))
    lists = [swinging(given, 20, first, counted=lightly_damped)[0] for first in (3.0, 200.0)]
    for other in lists[1:]:
        np.testing.assert_allclose(other, lists[0], rtol=1e-6)


@pytest.mark.parametrize(("count", "heavy"), [(60, 100), (400, 100), (60, 12)])
def test_a_continuum_of_heavily_damped_motions_is_left_out(count: int, heavy: int) -> None:
    """And as many as a machine may have are not."""
    slow = 30.0 * (-0.8 + 0.6j) * np.linspace(1.0, 1.05, heavy)
    light = 2e3 * np.sin(0.5 * np.pi * np.arange(1, count + 1) / (count + 1)) * (-0.01 + 1j * np.sqrt(1.0 - 1e-4))
    each = np.append(slow, light)
    stiffness, damping = csc_array(np.diag(np.abs(each) ** 2)), csc_array(np.diag(-2.0 * each.real))
    given = pencil(stiffness, damping, csc_array(np.eye(each.size)), none(each.size))
    for wanted in (1, 5):
        values = swinging(given, wanted, counted=lightly_damped)[0]
        expected = np.append(slow if heavy == 12 else [], light[:wanted])
        np.testing.assert_allclose(values, expected[np.argsort(expected.imag)], rtol=1e-6)

"""The closure of the energy account, on numbers added by hand."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.observation.observer import EnergyAccount
from beltdyn.system.arrays import ENERGY_WORKS

STORED = np.array([10.0, 14.0, 13.0, 11.0])
WORK = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [8.0, -1.0, 1.0, 0.5, 0.4, 0.2, 0.2, 0.2],
        [9.0, -2.0, 2.0, 1.0, 0.4, 0.2, 0.2, 0.2],
        [7.0, -1.0, 3.0, 1.1, 0.4, 0.2, 0.2, 0.2],
    ]
)
POTENTIAL = np.zeros((4, 2))
ERROR = [0.0, -0.5, 0.0, 0.1]
PUT_IN = [10.0, 19.0, 21.0, 21.0]


def closure(account: EnergyAccount, stored: FloatArray, potential: FloatArray, work: FloatArray) -> FloatArray:
    return account.closure(stored, potential, work, np.ones(len(stored), dtype=np.bool_))


def test_error_relative_to_the_energy_put_in() -> None:
    np.testing.assert_allclose(closure(EnergyAccount(), STORED, POTENTIAL, WORK), np.divide(ERROR, PUT_IN), atol=1e-15)


@pytest.mark.parametrize("cut", [1, 2, 3])
def test_chunks_do_not_matter(cut: int) -> None:
    account = EnergyAccount()
    parts = [closure(account, STORED[part], POTENTIAL[part], WORK[part]) for part in (slice(cut), slice(cut, None))]
    np.testing.assert_array_equal(np.concatenate(parts), closure(EnergyAccount(), STORED, POTENTIAL, WORK))


def test_what_is_put_in_between_counts_where_it_is_not_shown() -> None:
    shown = np.array([True, False, False, True])
    found = EnergyAccount().closure(STORED[shown], POTENTIAL, WORK, shown)
    np.testing.assert_array_equal(found, closure(EnergyAccount(), STORED, POTENTIAL, WORK)[shown])


def test_nothing_put_in() -> None:
    np.testing.assert_array_equal(
        closure(EnergyAccount(), np.zeros(3), np.zeros((3, 2)), np.zeros((3, len(ENERGY_WORKS)))), 0.0
    )


@pytest.mark.parametrize("level", [0.0, -1e3, 1e3])
def test_the_zero_of_springs_and_weight_does_not_matter(level: float) -> None:
    """What they do counts as put in, either way: 2 J and 3 J at the most."""
    potential = level + np.array([[0.0, 0.0], [2.0, -3.0], [-1.0, 1.0], [0.0, 0.0]])
    put_in = np.add(PUT_IN, [0.0, 5.0, 5.0, 5.0])
    error = np.add(ERROR, [0.0, -1.0, 0.0, 0.0])
    np.testing.assert_allclose(closure(EnergyAccount(), STORED, potential, WORK), error / put_in, atol=1e-12)

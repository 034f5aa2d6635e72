"""The closure of the energy account, on numbers added by hand."""

import numpy as np
import pytest

from beltdyn.solve.energy import EnergyAccount
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


def test_error_relative_to_the_energy_put_in() -> None:
    np.testing.assert_allclose(EnergyAccount().closure(STORED, POTENTIAL, WORK), np.divide(ERROR, PUT_IN), atol=1e-15)


@pytest.mark.parametrize("cut", [1, 2, 3])
def test_chunks_do_not_matter(cut: int) -> None:
    account = EnergyAccount()
    parts = [account.closure(STORED[part], POTENTIAL[part], WORK[part]) for part in (slice(cut), slice(cut, None))]
    np.testing.assert_array_equal(np.concatenate(parts), EnergyAccount().closure(STORED, POTENTIAL, WORK))


def test_nothing_put_in() -> None:
    np.testing.assert_array_equal(
        EnergyAccount().closure(np.zeros(3), np.zeros((3, 2)), np.zeros((3, len(ENERGY_WORKS)))), 0.0
    )


@pytest.mark.parametrize("level", [0.0, -1e3, 1e3])
def test_the_zero_of_springs_and_weight_does_not_matter(level: float) -> None:
    """What they do counts as put in, either way: 2 J and 3 J at the most."""
    potential = level + np.array([[0.0, 0.0], [2.0, -3.0], [-1.0, 1.0], [0.0, 0.0]])
    put_in = np.add(PUT_IN, [0.0, 5.0, 5.0, 5.0])
    error = np.add(ERROR, [0.0, -1.0, 0.0, 0.0])
    np.testing.assert_allclose(EnergyAccount().closure(STORED, potential, WORK), error / put_in, atol=1e-12)

"""The closure of the energy account, on numbers added by hand."""

import numpy as np
import pytest

from beltdyn.solve.energy import EnergyAccount
from beltdyn.system.arrays import POWERS

STORED = np.array([10.0, 14.0, 13.0, 11.0])
WORK = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [8.0, -1.0, 1.0, 0.5, 0.4, 0.3, 0.3],
        [9.0, -2.0, 2.0, 1.0, 0.4, 0.3, 0.3],
        [7.0, -1.0, 3.0, 1.1, 0.4, 0.3, 0.3],
    ]
)
ERROR = [0.0, -0.5, 0.0, 0.1]
PUT_IN = [10.0, 19.0, 21.0, 21.0]


def test_error_relative_to_the_energy_put_in() -> None:
    np.testing.assert_allclose(EnergyAccount().closure(STORED, WORK), np.divide(ERROR, PUT_IN), atol=1e-15)


@pytest.mark.parametrize("cut", [1, 2, 3])
def test_chunks_do_not_matter(cut: int) -> None:
    account = EnergyAccount()
    parts = [account.closure(STORED[:cut], WORK[:cut]), account.closure(STORED[cut:], WORK[cut:])]
    np.testing.assert_array_equal(np.concatenate(parts), EnergyAccount().closure(STORED, WORK))


def test_nothing_put_in() -> None:
    np.testing.assert_array_equal(EnergyAccount().closure(np.zeros(3), np.zeros((3, len(POWERS)))), 0.0)

"""Closure of the energy account: the worst instant, and shares of the energy that was put in."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.results.energy_balance import energy_put_in, largest_closure, largest_numerical_share

TIME = np.array([0.0, 1.0, 2.0, 3.0])
NOTHING = np.zeros(4)
STORED = {"kinetic_energy": 2.0, "strain_energy": 3.0, "penalty_energy": 0.5}


def account(**changed: list[float]) -> xr.Dataset:
    """An account of a belt that holds 5.5 J at first."""
    works = ("driver_work", "torque_work", "spring_energy", "potential_energy", "numerical_loss")
    made: dict[str, Any] = dict.fromkeys(works, NOTHING) | {
        name: np.array([value, 9.0, 9.0, 9.0]) for name, value in STORED.items()
    }
    return xr.Dataset({name: ("time", values) for name, values in (made | changed).items()}, {"time": TIME})


@pytest.mark.parametrize("errors", [[0.0, 1e-4, -3e-4, 2e-4], [0.0, -1e-4, 3e-4, -2e-4]])
def test_the_largest_error_keeps_its_sign(errors: list[float]) -> None:
    assert largest_closure(account(energy_closure=errors)) == (2.0, errors[2])


def test_an_error_that_is_no_number_is_the_largest() -> None:
    found = largest_closure(account(energy_closure=[0.0, np.nan, 1.0, np.nan]))
    assert found.time == 1.0
    assert np.isnan(found.error)


def test_at_first_what_is_stored_was_put_in() -> None:
    np.testing.assert_array_equal(energy_put_in(account()), 5.5)


@pytest.mark.parametrize("name", ["driver_work", "torque_work", "spring_energy", "potential_energy"])
def test_works_count_either_way_and_never_less_than_before(name: str) -> None:
    """A work of -4 J put in 4 J; what comes back later was put in all the same; where the count begins is no matter."""
    work = np.array([0.0, -4.0, 1.0, 6.0])
    for begin in (0.0, 100.0):
        np.testing.assert_allclose(energy_put_in(account(**{name: list(begin + work)})), [5.5, 9.5, 9.5, 11.5])


def test_works_of_different_kinds_do_not_cancel() -> None:
    both = account(driver_work=[0.0, 4.0, 4.0, 4.0], torque_work=[0.0, -3.0, -3.0, -3.0])
    np.testing.assert_allclose(energy_put_in(both), [5.5, 12.5, 12.5, 12.5])


def test_the_share_of_the_integrator() -> None:
    """1.5 J of 5.5 + 2 J."""
    lossy = account(driver_work=[0.0, 1.0, 2.0, 94.5], numerical_loss=[0.0, 0.1, 1.5, 1.6])
    assert largest_numerical_share(lossy) == pytest.approx((2.0, 0.2))
    assert largest_numerical_share(account(numerical_loss=[0.0, 0.0, -1.1, 0.0])) == pytest.approx((2.0, -0.2))


def test_a_belt_to_which_nothing_was_given_has_lost_no_share() -> None:
    empty = account(**{name: [0.0] * 4 for name in STORED}, numerical_loss=[0.0, 1.0, 1.0, 1.0])
    assert largest_numerical_share(empty) == (0.0, 0.0)

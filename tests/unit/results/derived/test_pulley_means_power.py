import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.results.derived import balance, pulley_powers

TORQUE = 30.0 * 0.08125


def test_what_comes_in_goes_out_or_is_lost(run: Run) -> None:
    powers = pulley_powers(run, start=0.7)
    np.testing.assert_allclose(powers["power_in"], np.tile([12.0 * TORQUE, -0.995 * 12.0 * TORQUE], (31, 1)))
    np.testing.assert_allclose(powers["power_lost"], 0.05 * 12.0)
    np.testing.assert_allclose(powers["power_in"], powers["power_out"] + powers["power_lost"])
    assert {values.attrs["units"] for values in powers.data_vars.values()} == {"W"}


def test_balance_of_a_part_of_the_run(run: Run) -> None:
    assert balance(run, start=0.7).losses["friction"] == pytest.approx(0.09 * 12.0)

"""The balance of tensions under other loads, against an independent balance of lumped spans."""

import numpy as np
import pytest

from beltdyn.model import prepare
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.tension_balance import TensionBalance
from tests.lumped.drawn_drives import drawn_drive


@pytest.mark.parametrize("seed", range(8))
def test_tensions_and_positions_change_with_loads_and_speed_as_in_the_lumped_balance(seed: int) -> None:
    """Of drives drawn at random; what is left is how bending changes with the tension: 0.3 % of the largest one."""
    drawn = drawn_drive(seed)
    drive, other = drawn.under(0.5), drawn.balance
    prepared = prepare(drive)
    rest = prepared.installation
    still = np.zeros((1, prepared.path.spans))
    balance = TensionBalance(prepared, SpanTension.uniform(rest.span_tensions[None]), still, rest.path.centers[None])
    loaded, idle = other.at(0.5), other.at(0.0)
    differences = loaded.tensions - loaded.tensions.mean()
    speed = other.speed * other.sense
    found = balance.under(np.stack([0.0 * differences, differences]), speed).states()
    change, expected = found.tension.mean[1] - found.tension.mean[0], loaded.tensions - idle.tensions
    np.testing.assert_allclose(change, expected, atol=3e-3 * float(loaded.tensions.max()))
    scale = np.array([one.scale for one in other.springs])
    moved = found.positions[1] - found.positions[0]
    np.testing.assert_allclose(moved / scale, (loaded.positions - idle.positions) / scale, atol=2e-3)


def test_without_other_loads_the_known_state_stays() -> None:
    prepared = prepare(drawn_drive(4).under(0.3))
    rest = prepared.installation
    tension, still = SpanTension.uniform(rest.span_tensions[None]), np.zeros((1, prepared.path.spans))
    balance = TensionBalance(prepared, tension, still, rest.path.centers[None])
    found = balance.under(np.zeros((3, prepared.path.spans)), 0.0).states()
    np.testing.assert_allclose(found.tension.mean, np.tile(rest.span_tensions, (3, 1)), rtol=1e-9)
    np.testing.assert_allclose(found.positions, np.tile(rest.tensioner_positions, (3, 1)), atol=1e-9)
    np.testing.assert_allclose(found.wrap, np.tile(rest.path.wrap_angles, (3, 1)), rtol=1e-9)

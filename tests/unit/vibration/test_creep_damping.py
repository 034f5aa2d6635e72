"""The part of damping by the slope of the friction law."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csc_array

from beltdyn.vibration.creep_damping import CREEP_SHARE, creep_damping

MASS, RATE, SLOPE, DAMPER = 2.0, 5e3, 2e3, 4.0


def sliding_mass(slope: float, damper: float) -> Any:
    """A mass with a damper, on a spring whose other end creeps under a friction of the slope (N s/m)."""
    return SimpleNamespace(
        stiffness=csc_array(np.array([[RATE, -RATE], [-RATE, RATE]])),
        damping=csc_array(np.diag([damper, slope])),
        mass=csc_array(np.diag([MASS, 0.0])),
    )


def mode(slope: float, damper: float) -> tuple[complex, np.ndarray]:
    """By the characteristic polynomial (M s^2 + D s) (C s + k) + k C s of degree three."""
    polynomial = [MASS * slope, MASS * RATE + damper * slope, (damper + slope) * RATE, 0.0]
    roots = np.roots(polynomial)
    value = complex(roots[np.argmax(roots.imag)])
    return value, np.array([1.0, RATE / (RATE + slope * value)])


@pytest.mark.parametrize("damper", [0.0, DAMPER])
def test_what_the_slope_adds_is_left_out_by_infinite_slope(damper: float) -> None:
    """To 3 %, the error of damping in proportion to the creep."""
    value, vector = mode(SLOPE, damper)
    adhering = -0.5 * damper / MASS
    before, after = (sliding_mass(slope, damper) for slope in (SLOPE, SLOPE / CREEP_SHARE))
    (found,) = creep_damping(before, after, np.array([value]), vector[:, None])
    assert found == pytest.approx((adhering - value.real) / abs(value), rel=0.03)


def test_without_a_change_nothing_is_added() -> None:
    value, vector = mode(SLOPE, DAMPER)
    same = sliding_mass(SLOPE, DAMPER)
    assert creep_damping(same, same, np.array([value]), vector[:, None]) == pytest.approx([0.0], abs=1e-9)


def test_a_mode_that_is_not_found_again_is_not_known() -> None:
    value, vector = mode(SLOPE, 0.0)
    before, after = sliding_mass(SLOPE, 0.0), sliding_mass(SLOPE, 0.0)
    after.stiffness = 100.0 * after.stiffness
    assert np.isnan(creep_damping(before, after, np.array([value]), vector[:, None])).all()

import numpy as np
import pytest

from validation.paper.distribution import Distribution, find_peak, fit_line

PLACE = np.linspace(0.0, 1.0, 401)


def forces(friction: np.ndarray, gliding: np.ndarray | None = None) -> Distribution:
    none = np.zeros(PLACE.size, dtype=bool)
    return Distribution(0.25 * PLACE, PLACE, 2e4 + 0.0 * PLACE, friction, none if gliding is None else gliding)


def test_a_straight_line_is_found() -> None:
    line = fit_line(forces(1000.0 + 400.0 * PLACE), "friction")
    assert (line.value, line.slope) == pytest.approx((1000.0, 400.0))
    assert line.level == pytest.approx(1200.0)
    assert max(line.deviation, line.deviation_with_ends) < 1e-12


def test_deviation_is_over_the_level() -> None:
    """A wave of amplitude 100 N/m, rms 71 N/m, over 1000 N/m; ten periods in the middle leave no slope to speak of."""
    line = fit_line(forces(-1000.0 + 100.0 * np.cos(2.0 * np.pi * PLACE / 0.06)), "friction")
    assert line.deviation == pytest.approx(0.0707, abs=1e-3)


def test_ends_count_where_they_do_not_glide() -> None:
    bump = 1000.0 + 3000.0 * (PLACE < 0.1)
    assert fit_line(forces(bump), "friction").deviation < 1e-12
    assert fit_line(forces(bump), "friction").deviation_with_ends == pytest.approx(3.0 * np.sqrt(0.1), rel=0.02)
    assert fit_line(forces(bump, PLACE < 0.1), "friction").deviation_with_ends < 1e-12


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_peak_rises_above_the_line_whatever_its_sign(sign: float) -> None:
    peak = 600.0 * np.exp(-(((PLACE - 0.95) / 0.01) ** 2))
    found = find_peak(forces(sign * (1000.0 + 200.0 * PLACE + peak)), at_exit=True)
    assert found.excess == pytest.approx(600.0 / 1100.0, rel=1e-3)
    assert found.force == pytest.approx(sign * 1790.0, rel=1e-3)
    assert found.distance == pytest.approx(0.0125, abs=1e-3)
    assert find_peak(forces(sign * (1000.0 + 200.0 * PLACE + peak)), at_exit=False).excess == pytest.approx(
        0.0, abs=1e-3
    )

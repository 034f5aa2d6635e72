"""What is left of the start of a run-up."""

import numpy as np
import pytest

from beltdyn.state.settling import _Left


@pytest.mark.parametrize(("decay", "left"), [(0.25, 0.02), (0.5, 0.1)])
def test_what_is_left_of_a_decaying_tension(decay: float, left: float) -> None:
    """A tension that falls exponentially to 100 N, by a factor from window to window: what is left is extrapolated."""
    windows = _Left()
    for number in range(5):
        time = np.linspace(number, number + 1.0, 400)
        start = left * 100.0 / decay**4.5  # in the middle of the last window this part is left
        windows.take(time, 100.0 + (start * decay**time)[:, None])
    assert windows.known
    assert windows.part == pytest.approx(left, rel=0.15)


def test_a_steady_ripple_leaves_nothing() -> None:
    """Windows hold two and a half waves, so that they begin at different places of them."""
    windows = _Left()
    for number in range(5):
        time = np.linspace(number, number + 1.0, 400)
        windows.take(time, 100.0 + 20.0 * np.cos(2.0 * np.pi * 4.5 * time)[:, None])
    assert windows.part < 0.01


def test_too_few_windows_tell_nothing() -> None:
    windows = _Left()
    for number in range(4):
        windows.take(np.linspace(number, number + 1.0, 9), np.full((9, 2), 50.0))
    assert not windows.known
    assert np.isnan(windows.part)

"""Kernels call functions of a user by their addresses."""

import math
import time
import warnings

import numpy as np
import pytest

from beltdyn.kernel import kernel
from beltdyn.kernel.callback import SlowFunctionWarning, address_of, call_at


@kernel
def twice(address: int, first: float, second: float, third: float) -> float:
    return 2.0 * call_at(address, first, second, third)


def smooth(first: float, second: float, third: float) -> float:
    return first * math.sin(second) + third


class Scale:
    value = 3.0
    known = {0.0: 1.0}  # noqa: RUF012


SCALE = Scale()


def scaled(_first: float, second: float, _third: float) -> float:
    return SCALE.value * second


def failing(_first: float, second: float, _third: float) -> float:
    return SCALE.known[second]


def test_a_compiled_function_is_called_by_kernels_and_by_python() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        address = address_of(smooth)
    expected = smooth(2.0, 0.7, -1.0)
    assert twice(address, 2.0, 0.7, -1.0) == pytest.approx(2.0 * expected, rel=1e-15)
    assert call_at(address, 2.0, 0.7, -1.0) == pytest.approx(expected, rel=1e-15)
    assert address_of(smooth) == address


def test_python_runs_what_numba_does_not_compile_and_its_cost_is_said_once() -> None:
    with pytest.warns(
        SlowFunctionWarning, match='the function "scaled" .*Python runs it, .* microseconds per call'
    ) as said:
        address = address_of(scaled)
    assert "SCALE" in str(said[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert address_of(scaled) == address
    assert twice(address, 0.0, 2.0, 0.0) == 12.0


def test_a_function_that_fails_gives_no_number_and_says_why() -> None:
    with pytest.warns(SlowFunctionWarning):
        address = address_of(failing)
    with pytest.warns(RuntimeWarning, match=r'the function "failing" failed: KeyError\(5.0\)'):
        assert np.isnan(twice(address, 0.0, 5.0, 0.0))


def test_an_interruption_in_a_function_that_python_runs_comes_back(signal_defaults: None) -> None:
    """It cannot pass through machine code, which would go on with a force of zero."""
    begun: list[float] = []
    armed: list[bool] = []

    def stopped(first: float, _second: float, _third: float) -> float:
        if armed:
            begun.append(first)
            raise KeyboardInterrupt
        return SCALE.value

    with pytest.warns(SlowFunctionWarning):
        address = address_of(stopped)
    armed.append(True)
    with pytest.raises(KeyboardInterrupt):  # noqa: PT012 (it comes a little later)
        assert math.isnan(call_at(address, 0.5, 0.0, 0.0))
        for _ in range(500):
            time.sleep(0.01)
    assert begun == [0.5]

"""The decorator of kernels: nothing is compiled before the first call, or at all where Python is to run them."""

import pickle
from time import perf_counter
from typing import Any

import numpy as np
import pytest

from beltdyn.kernel import compiles_quickly, interpreted, kernel, runs_compiled


@kernel
def square(x: float) -> float:
    """Square of a number."""
    return x * x


@kernel(inline=True)
def _cube(x: float) -> float:
    return x * square(x)


def test_a_kernel_has_the_name_and_the_words_of_its_function() -> None:
    assert (square.__name__, square.__doc__) == ("square", "Square of a number.")
    assert square(3.0) == 9.0


def test_python_runs_a_kernel_and_those_that_it_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    """With arrays in place of numbers; afterwards they are compiled as ever."""

    def refuse(*_: object) -> None:
        raise AssertionError("compiled")

    monkeypatch.setattr("beltdyn.kernel.compiler.new_dispatcher", refuse)

    @kernel
    def fresh(x: float) -> float:
        return 2.0 * x

    numbers: Any = np.array([1.0, 2.0])
    np.testing.assert_array_equal(interpreted(_cube)(numbers), [1.0, 8.0])
    assert interpreted(fresh)(4.0) == 8.0
    with pytest.raises(AssertionError, match="compiled"):
        fresh(4.0)


def test_what_is_not_compiled_is_known_without_compilation() -> None:
    factor = perf_counter()  # no other run of the test has it, or its machine code

    @kernel
    def fresh(x: float) -> float:
        return factor * x

    assert not runs_compiled(fresh, 1.0)
    assert not fresh.dispatcher.signatures  # type: ignore[attr-defined]
    assert fresh(1.0) == factor
    assert runs_compiled(fresh, 1.0) or not compiles_quickly()
    assert not runs_compiled(fresh, 1)  # for integers it is another


def test_an_error_ends_the_interpretation() -> None:
    @kernel
    def wrong(x: float) -> float:
        return x.missing  # type: ignore[attr-defined,no-any-return]

    with pytest.raises(AttributeError):
        interpreted(wrong)(1.0)
    assert square(2.0) == 4.0


def test_a_kernel_travels_between_processes() -> None:
    again = pickle.loads(pickle.dumps(_reader))
    assert again(5.0) == 5.0
    assert again.inline is False


def _read(x: float) -> float:
    return x


_reader = kernel(_read)


@kernel
def _halved(number: float) -> float:
    return 0.5 * number


def test_below_the_least_number_an_interpreted_kernel_gives_zero_whatever_numpy_is_told() -> None:
    with np.errstate(all="raise"):
        found = interpreted(_halved)(np.array([5e-324, 1.0]))  # type: ignore[arg-type]
        np.testing.assert_array_equal(found, [0.0, 0.5])
        with pytest.raises(FloatingPointError, match="overflow"):
            interpreted(_cube)(np.array([1e200]))  # type: ignore[arg-type]

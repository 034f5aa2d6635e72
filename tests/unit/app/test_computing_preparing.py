"""What is compiled is told of, what is compiled already is not."""

import numba

from beltdyn.app.computing import tell_of_compilation


def test_compilation_is_told_of_once_with_all_that_a_function_calls() -> None:
    told: list[bool] = []
    tell_of_compilation(told.append)
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: 2 * inner(x))
    assert outer(1) == 4
    assert told == [True, False]
    assert outer(2) == 6
    assert told == [True, False]
    assert outer(1.5) == 5.0
    assert told == [True, False] * 2

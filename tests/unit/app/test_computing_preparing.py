"""What is compiled is counted, what is compiled already is not."""

import numba

from beltdyn.app.computing import Counted, in_words, tell_of_compilation


def test_compilation_is_counted_with_all_that_a_function_calls() -> None:
    told: list[Counted] = []
    tell_of_compilation(told.append)
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: 2 * inner(x))
    assert outer(1) == 4
    assert told == sorted(set(told))  # each count once, and never fewer than before
    assert told[0][0] < told[0][1]
    assert told[-1][0] == told[-1][1]
    before = len(told)
    assert outer(2) == 6
    assert len(told) == before
    assert outer(1.5) == 5.0
    assert told[-1][0] == told[-1][1] > told[before - 1][1]


def test_counts_are_put_into_words() -> None:
    assert in_words((96, 240)) == "compiling kernels, once on this machine: 96 of 240"

"""Searches that are ended by a limit of processor time."""

import time

import pytest

from beltdyn.errors import ConvergenceError, TimeLimitError
from beltdyn.solvers.time_limit import spend_time, time_limit


def _search(seconds: float) -> None:
    """Work for some processor time in small steps."""
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        spend_time()


def test_a_search_is_ended_by_its_limit_and_by_no_other() -> None:
    _search(0.02)
    with time_limit(None):
        _search(0.02)
    with time_limit(0.01), pytest.raises(TimeLimitError, match=r"ended after 0\.01 s"):
        _search(60.0)
    _search(0.02)


def test_what_is_used_up_stays_used_up() -> None:
    with time_limit(0.0):
        for _ in range(2):
            with pytest.raises(TimeLimitError):
                spend_time()
        with time_limit(None):
            spend_time()


def test_a_long_step_counts_as_compilation(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 100.0, 100.5, 200.0])
    monkeypatch.setattr(time, "thread_time", lambda: next(clock))
    with time_limit(2.0):
        spend_time()  # one second of the hundred
        spend_time()
        with pytest.raises(TimeLimitError):
            spend_time()


def test_a_ladder_of_searches_does_not_take_it_for_a_search_that_failed() -> None:
    assert not issubclass(TimeLimitError, ConvergenceError)

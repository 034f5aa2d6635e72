"""A limit of the processor time that searches may take, for answers that somebody waits for."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from beltdyn.errors import TimeLimitError

_LONGEST_STEP = 1.0
"""Time between two calls of `spend_time` that counts, s: no step of a search takes longer, only compilation does."""


@dataclass
class _Budget:
    """Processor time that is left, s."""

    seconds: float
    left: float
    last: float


_budget: ContextVar[_Budget | None] = ContextVar("budget", default=None)


@contextmanager
def time_limit(seconds: float | None) -> Iterator[None]:
    """Limit the processor time of the searches within; None limits nothing."""
    token = _budget.set(None if seconds is None else _Budget(seconds, seconds, time.thread_time()))
    try:
        yield
    finally:
        _budget.reset(token)


def spend_time() -> None:
    """Count the time since the last call; TimeLimitError once the limit is passed. For each step of a search."""
    budget = _budget.get()
    if budget is None:
        return
    now = time.thread_time()
    budget.left -= min(now - budget.last, _LONGEST_STEP)
    budget.last = now
    if budget.left <= 0.0:
        raise TimeLimitError(f"the search was ended after {budget.seconds:g} s of processor time.")

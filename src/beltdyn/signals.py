"""Signals that ask a program to end: all of them do so in order, with results closed."""

import io
import os
import signal
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import current_thread, main_thread
from types import FrameType

ENDING = tuple(
    signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if name in signal.Signals.__members__
)
"""Ctrl-C, the request of another program or of a shutdown, a closed terminal, and Ctrl-Break, where there are any."""


_received: list[int] = []


@contextmanager
def ending_in_order() -> Iterator[None]:
    """Let signals that ask the program to end raise KeyboardInterrupt, as Ctrl-C does.

    Those that whoever started the program has told it to ignore stay so, such as SIGHUP under ``nohup``.
    """
    _received.clear()
    handlers = {number: signal.getsignal(number) for number in ENDING}
    ours = [number for number in ENDING if handlers[number] in (signal.SIG_DFL, signal.default_int_handler)]
    if current_thread() is not main_thread():
        ours = []
    for number in ours:
        signal.signal(number, _interrupt)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, handlers[number])


def exit_code() -> int:
    """Exit code of a program that was interrupted: 128 and the number of the signal, 130 for Ctrl-C."""
    return 128 + (_received or [signal.SIGINT])[0]


def _interrupt(number: int, frame: FrameType | None) -> None:
    _received.append(number)
    if number == getattr(signal, "SIGHUP", None):
        _leave_terminal()
    raise KeyboardInterrupt


def _leave_terminal() -> None:
    """Say nothing more where the terminal is gone."""
    for name in ("stdout", "stderr"):
        try:
            is_device = stat.S_ISCHR(os.fstat(getattr(sys, name).fileno()).st_mode)
        except (OSError, ValueError):
            continue
        if is_device:
            setattr(sys, name, io.StringIO())


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Let signals with a handler wait until the block is left, so that it is done as a whole.

    Python runs handlers in the main thread alone: in others there is nothing to wait for.
    """
    if current_thread() is not main_thread():
        yield
        return
    waiting: list[int] = []
    handlers = {}
    try:
        for number in ENDING:
            if callable(signal.getsignal(number)):
                handlers[number] = signal.signal(number, lambda number, _: waiting.append(number))
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for one in waiting[:1]:
            signal.raise_signal(one)


@contextmanager
def closing() -> Iterator[None]:
    """Finish an analysis as `uninterrupted`: whoever interrupts that has the results a moment later, as they are."""
    with suppress(KeyboardInterrupt), uninterrupted():
        yield

"""Signals that ask a program to end: all of them do so in order, with results closed."""

import io
import os
import signal
import stat
import sys
import time
from _thread import start_new_thread
from collections.abc import Iterator
from contextlib import contextmanager, suppress

TYPE_CHECKING = False
if TYPE_CHECKING:  # their imports take time in which no signal is heeded
    from types import FrameType
    from typing import Any

ENDING = tuple(
    signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if name in signal.Signals.__members__
)
"""Ctrl-C, the request of another program or of a shutdown, a closed terminal, and Ctrl-Break, where there are any."""

_RETRY = 0.02
"""Time after which a signal that came at a bad moment comes again, s."""
_PATIENCE = 500
"""How often it does, at most: for ten seconds."""

_received: list[int] = []


def begin_program() -> None:
    """Let the signals end a program in one line while it imports what it needs, and keeps nothing yet."""
    for number in ENDING:
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _leave)


def end_program() -> None:
    """Let the signals of `begin_program` change nothing: all is done, and Python takes its time to end."""
    for number in _ours(_leave):
        signal.signal(number, signal.SIG_IGN)


def _leave(number: int, frame: "FrameType | None") -> None:
    if not _received:
        with suppress(OSError):
            os.write(2, b"error: interrupted\n")
    os._exit(128 + number)


def _ours(*handlers: object) -> list[signal.Signals]:
    """Signals with one of some handlers; Python lets the main thread alone change them."""
    from threading import current_thread, main_thread  # not before the program has handlers

    return [one for one in ENDING if current_thread() is main_thread() and signal.getsignal(one) in handlers]


@contextmanager
def ending_in_order() -> Iterator[None]:
    """Let signals that ask the program to end raise KeyboardInterrupt, as Ctrl-C does.

    Those that whoever started the program has told it to ignore stay so, such as SIGHUP under ``nohup``.
    """
    _received.clear()
    hook = sys.unraisablehook
    handlers = {n: signal.getsignal(n) for n in _ours(signal.SIG_DFL, signal.default_int_handler, _leave)}
    for number in handlers:
        signal.signal(number, _interrupt)
    if handlers:
        sys.unraisablehook = lambda error: _heed(error, hook)
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in handlers.items():
            signal.signal(number, handler)


def exit_code() -> int:
    """Exit code of a program that was interrupted: 128 and the number of the signal, 130 for Ctrl-C."""
    return 128 + (_received or [signal.SIGINT])[0]


def interrupted() -> bool:
    """Whether a signal has asked for the end since `ending_in_order` began."""
    return bool(_received)


def _interrupt(number: int, frame: "FrameType | None") -> None:
    _received.append(number)
    if number == getattr(signal, "SIGHUP", None):
        _leave_terminal()
    if len(_received) < _PATIENCE and _is_swallowed(frame):
        start_new_thread(_send_again, (number,))
        return
    raise KeyboardInterrupt


def _is_swallowed(frame: "FrameType | None") -> bool:
    """Whether KeyboardInterrupt would get lost: in an import, which leaves half a module, or where objects end."""
    while frame is not None:
        code = frame.f_code
        if code.co_name == "__del__" or code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _send_again(number: int) -> None:
    """Send a signal a little later; a thread without the locks of `threading`, which the interrupted code may hold."""
    time.sleep(_RETRY)
    os.kill(os.getpid(), number) if os.name == "posix" else signal.raise_signal(number)


def _heed(error: "Any", hook: "Any") -> None:
    """Send a signal again whose KeyboardInterrupt got lost in a callback; all else is reported."""
    if isinstance(error.exc_value, KeyboardInterrupt) and _received:
        start_new_thread(_send_again, (_received[0],))
    else:
        hook(error)


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
    waiting: list[int] = []
    handlers = {number: signal.getsignal(number) for number in ENDING}
    ours = [number for number in _ours(*handlers.values()) if callable(handlers[number])]
    try:
        for number in ours:
            signal.signal(number, lambda number, _: waiting.append(number))
        yield
    finally:
        for number in ours:
            signal.signal(number, handlers[number])
        for one in waiting[:1]:
            signal.raise_signal(one)


@contextmanager
def closing() -> Iterator[None]:
    """Finish an analysis as `uninterrupted`: whoever interrupts that has the results a moment later, as they are."""
    with suppress(KeyboardInterrupt), uninterrupted():
        yield

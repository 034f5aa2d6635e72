"""Signals that ask for the end are heeded in order, and not in the middle of what must be whole."""

import signal
import subprocess
import sys
import time
from pathlib import Path
from threading import Thread

import pytest

from beltdyn.signals import (
    ENDING,
    begin_program,
    closing,
    end_program,
    ending_in_order,
    exit_code,
    interrupted,
    uninterrupted,
)

pytestmark = pytest.mark.usefixtures("signal_defaults")


def send(number: int) -> None:
    signal.raise_signal(number)


@pytest.mark.parametrize("number", ENDING)
def test_each_signal_interrupts(number: signal.Signals) -> None:
    before = {one: signal.getsignal(one) for one in ENDING}
    with ending_in_order(), pytest.raises(KeyboardInterrupt):
        send(number)
    assert exit_code() == 128 + number
    assert {one: signal.getsignal(one) for one in ENDING} == before


def test_what_was_ignored_stays_so() -> None:
    """As SIGHUP under nohup."""
    number = ENDING[-1]
    before = signal.signal(number, signal.SIG_IGN)
    try:
        with ending_in_order():
            send(number)
        assert signal.getsignal(number) is signal.SIG_IGN
    finally:
        signal.signal(number, before)


@pytest.mark.parametrize("number", ENDING)
def test_signals_wait_for_the_end_of_a_block(number: signal.Signals) -> None:
    done = []

    def work() -> None:
        with uninterrupted():
            send(number)
            send(number)
            done.append(1)

    with ending_in_order():
        before = signal.getsignal(number)
        with pytest.raises(KeyboardInterrupt):
            work()
        assert done == [1]
        assert signal.getsignal(number) is before


def test_other_threads_need_no_wait() -> None:
    done = []

    def work() -> None:
        with uninterrupted():
            done.append(signal.getsignal(signal.SIGINT))

    thread = Thread(target=work)
    thread.start()
    thread.join()
    assert done == [signal.getsignal(signal.SIGINT)]


def test_what_is_closing_ends_as_it_is() -> None:
    done = []
    with closing():
        signal.raise_signal(signal.SIGINT)
        done.append("closed")
    assert done == ["closed"]


WAIT = 5.0
"""Longer than a signal takes to come again, s."""


def test_signals_wait_for_the_end_of_an_import(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half an import would be taken for a module, or for one that is missing."""
    (tmp_path / "interrupted_import.py").write_text(
        "import signal, time\nsignal.raise_signal(signal.SIGTERM)\ntime.sleep(0.1)\nwhole = True\n", encoding="utf-8"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with ending_in_order(), pytest.raises(KeyboardInterrupt):  # noqa: PT012
        import interrupted_import  # type: ignore[import-not-found]

        assert interrupted_import.whole
        time.sleep(WAIT)
    assert exit_code() == 128 + signal.SIGTERM
    del sys.modules["interrupted_import"]


class Ends:
    def __init__(self) -> None:
        self.ended = list[bool]()

    def __del__(self) -> None:
        send(signal.SIGINT)
        self.ended.append(True)


def test_signals_wait_for_the_end_of_objects() -> None:
    """Python reports what is raised there, and goes on."""
    ended = (one := Ends()).ended
    with ending_in_order(), pytest.raises(KeyboardInterrupt):  # noqa: PT012
        del one
        assert ended == [True]
        time.sleep(WAIT)


def test_an_interruption_that_a_callback_swallows_comes_again() -> None:
    import ctypes

    callback = ctypes.CFUNCTYPE(None)(lambda: send(signal.SIGINT))
    with ending_in_order(), pytest.raises(KeyboardInterrupt):  # noqa: PT012
        callback()
        time.sleep(WAIT)
    assert interrupted()


PROGRAM = """
import os, signal
from beltdyn.signals import begin_program, end_program
begin_program()
{0}
signal.raise_signal(signal.{1})
print("end")
"""


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_a_program_that_begins_ends_in_a_line_and_one_that_ends_goes_on(number: str) -> None:
    words = [sys.executable, "-c", PROGRAM.format("", number)]
    begun = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (begun.returncode, begun.stdout, begun.stderr) == (128 + signal.Signals[number], "", "error: interrupted\n")
    words = [sys.executable, "-c", PROGRAM.format("end_program()", number)]
    ended = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "end\n", "")


def test_what_a_program_was_told_to_ignore_stays_so_from_its_beginning() -> None:
    before = {one: signal.signal(one, signal.SIG_IGN) for one in ENDING}
    begin_program()
    assert {signal.getsignal(one) for one in ENDING} == {signal.SIG_IGN}
    end_program()
    for one, handler in before.items():
        signal.signal(one, handler)

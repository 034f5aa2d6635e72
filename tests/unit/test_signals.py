"""Signals that ask for the end are heeded in order, and not in the middle of what must be whole."""

import signal
from threading import Thread

import pytest

from beltdyn.signals import ENDING, closing, ending_in_order, exit_code, uninterrupted

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

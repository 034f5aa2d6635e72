"""Processes that compute beside this one are begun and ended in one way."""

import os
import time

import pytest

from beltdyn.designs.processes import SPAWN, LocalProcesses, heeding, start_process
from beltdyn.solvers.run_progress import Progress


def test_a_process_that_is_killed_is_replaced() -> None:
    workers = LocalProcesses(1)
    try:
        first = workers.submit(os.getpid).result()
        (process,) = workers.processes
        assert process.pid == first != os.getpid()
        process.kill()
        process.join()
        error = workers.submit(os.getpid).exception()
        assert error is None or workers.lost(error)
        assert workers.submit(os.getpid).result() != first
    finally:
        workers.close()


def test_killing_waits_for_nothing() -> None:
    workers = LocalProcesses(1)
    workers.submit(os.getpid).result()
    (process,) = workers.processes
    workers.submit(time.sleep, 600.0)
    begun = time.monotonic()
    workers.kill()
    with pytest.raises(ProcessLookupError):  # the exit code may have gone to the thread of the pool
        os.kill(process.pid or 0, 0)
    assert time.monotonic() - begun < 60.0


def test_a_process_alone_does_its_work_and_ends() -> None:
    done = SPAWN.Event()
    process = start_process(done.set)
    process.join(120.0)
    assert process.exitcode == 0
    assert done.is_set()


def test_what_heeds_tells_of_progress() -> None:
    told: list[Progress] = []
    step = Progress(0.5, 1.0, 0.1, 1, "integrating")
    heeding(told.append)(step)
    assert told == [step]


def test_a_pool_that_is_abandoned_cancels_what_waits() -> None:
    workers = LocalProcesses(1)
    workers.submit(os.getpid).result()
    waiting = [workers.submit(time.sleep, 0.5) for _ in range(8)]
    workers.close(abandon=True)
    assert any(one.cancelled() for one in waiting)
    with pytest.raises(RuntimeError):
        workers.submit(os.getpid)

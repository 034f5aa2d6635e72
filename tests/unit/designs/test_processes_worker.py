"""Who computes is chosen by words, and wrong ones are told."""

import asyncio
import sys
from concurrent.futures import CancelledError, Future

import pytest

from beltdyn.designs.processes import DaskWorkers, LocalProcesses, ThisProcess, hand_on, workers_of
from beltdyn.errors import ModelError


def test_one_job_is_this_process() -> None:
    assert isinstance(workers_of(1, None), ThisProcess)


def test_processes_are_as_many_as_asked_for() -> None:
    workers = workers_of(3, None)
    assert isinstance(workers, LocalProcesses)
    assert workers.slots == 3
    workers.close()


def test_jobs_are_none_of_a_cluster() -> None:
    with pytest.raises(ModelError, match="jobs = 2 applies to processes on this machine"):
        workers_of(2, "tcp://host:1")


def test_the_extra_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ModelError, match=r"its extra beltdyn\[cluster\]"):
        DaskWorkers("tcp://host:1")


def test_an_address_that_is_none_is_told() -> None:
    pytest.importorskip("distributed")
    with pytest.raises(ModelError, match="does not answer"):
        DaskWorkers("nonsense://nowhere:1")


@pytest.mark.parametrize("error", [RuntimeError("its worker died"), KeyError("lost"), CancelledError()])
def test_whatever_becomes_of_a_task_is_told(error: Exception) -> None:
    """Of one too whose result was lost with its worker, and which fails as it is waited for."""

    async def task() -> None:
        raise error

    future: Future[None] = Future()
    asyncio.run(hand_on(task(), future))
    assert future.done()
    if isinstance(error, CancelledError):
        assert future.cancelled()
    else:
        assert future.exception() is error

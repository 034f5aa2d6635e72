"""Processes that compute beside this one are begun and ended in one way."""

import multiprocessing
import os
import shutil
import time
from pathlib import Path
from threading import Event
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.designs import processes
from beltdyn.designs.processes import SPAWN, LocalProcesses, heeding, start_process
from beltdyn.errors import LostOutputError, ModelError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.solvers.run_progress import Progress, Report


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


@pytest.mark.parametrize(
    ("error", "writes", "kept"),
    [(ModelError, True, False), (LostOutputError, True, False), (ValueError, False, False), (ValueError, True, True)],
)
@pytest.mark.provokes_internal_errors
def test_partial_results_of_what_failed_are_kept(
    saved_run: Path,
    drive: Drive,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    error: type[Exception],
    writes: bool,
    kept: bool,
) -> None:
    """Unless nothing was written, or the error says that there is nothing to keep."""

    def write(drive: Drive, file: Path, progress: Report, overwrite: bool) -> Run:
        progress(Progress(0.25, 1.0, 0.1, 1))
        if writes:
            shutil.copy(saved_run, file)
        raise error("the cause")

    monkeypatch.setattr(processes, "_parts", [np.nan, np.nan], raising=False)
    analysis: Any = SimpleNamespace(name="simulate", write=write)
    ending = processes.analyse(1, tmp_path / "run.nc", drive, processes.Work(analysis, {}, False, None))
    assert "the cause" in ending.error
    assert np.array_equal(processes._parts, [np.nan, 0.25], equal_nan=True)
    assert (ending.kept, ending.summary is not None) == (kept, kept)
    assert ending.status == ("completed" if kept else "failed")


@pytest.mark.parametrize("stop", [None, Event()])
def test_a_process_ends_with_its_parent(stop: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """As soon as the simulation on its way has closed its file, which it is told to do."""
    codes, parent = list[int](), SimpleNamespace(join=lambda: None)
    monkeypatch.setattr(processes, "_stop", stop)
    monkeypatch.setattr(multiprocessing, "parent_process", lambda: parent)
    monkeypatch.setattr(os, "_exit", codes.append)
    processes._follow_parent()
    assert codes == [1]
    assert stop is None or stop.is_set()


def test_a_pool_that_is_abandoned_cancels_what_waits() -> None:
    workers = LocalProcesses(1)
    workers.submit(os.getpid).result()
    waiting = [workers.submit(time.sleep, 0.5) for _ in range(8)]
    workers.close(abandon=True)
    assert any(one.cancelled() for one in waiting)
    with pytest.raises(RuntimeError):
        workers.submit(os.getpid)

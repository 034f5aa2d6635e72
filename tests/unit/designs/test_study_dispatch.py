"""Every point comes back once, whoever computes it, and whatever is killed meanwhile."""

import dataclasses
import os
import random
import signal
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
import pytest

from beltdyn.designs.point_work import Outcome, PointWork
from beltdyn.designs.processes import DaskWorkers, LocalProcesses, ThisProcess, Workers
from beltdyn.designs.study import Dispatch, study
from beltdyn.errors import SimulationError
from beltdyn.kinds import register
from beltdyn.model import Drive, ParameterStudy

Make = Callable[..., PointWork]


def compute(workers: Workers, work: PointWork, widths: list[float]) -> list[Outcome]:
    """Have a point computed for each width."""
    found: list[Outcome] = []

    def take(outcomes: list[Outcome], units: Mapping[str, str]) -> None:
        assert set(units) <= {"width"}
        found.extend(outcomes)

    Dispatch(workers, work, lambda point: {"belt.width": widths[point]}, take, lambda: None).run(range(len(widths)))
    return found


def require_each_once(found: list[Outcome], widths: list[float]) -> None:
    assert sorted(one.point for one in found) == list(range(len(widths)))
    assert all(one.values["width"] == widths[one.point] for one in found if not one.failure)


def test_a_point_that_fails_leaves_the_others_alone(tiny_work: Make) -> None:
    widths = [0.01, -1.0, 0.02]
    found = compute(ThisProcess(), tiny_work(), widths)
    require_each_once(found, widths)
    (failed,) = [one for one in found if one.failure]
    assert failed.point == 1
    assert "belt.width = -1.0" in failed.failure


def test_tiny_points_travel_in_chunks(tiny_work: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    """Chunks grow towards a second of computing, and the last points are shared out."""
    sizes: list[int] = []
    inner = ThisProcess.submit

    def submit(self: ThisProcess, function: Callable[..., object], work: PointWork, points: list[object]) -> object:
        sizes.append(len(points))
        return inner(self, function, work, points)

    monkeypatch.setattr(ThisProcess, "submit", submit)
    widths = np.linspace(0.0101, 0.02, 300).tolist()
    require_each_once(compute(ThisProcess(), tiny_work(), widths), widths)
    assert sizes[0] == 1
    assert max(sizes) > 20
    assert sizes[-1] <= 2


@pytest.mark.provokes_internal_errors
def test_a_chunk_that_cannot_be_passed_on_loses_one_point(tiny_work: Make) -> None:
    """What a worker answers may be unreadable here: such a point fails alone."""

    class Garbled(ThisProcess):
        def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
            if any(changes["belt.width"] == 0.013 for _, changes in arguments[1]):
                future: Future[Any] = Future()
                try:
                    dataclasses.replace(arguments[0], nothing=1)
                except TypeError as error:
                    future.set_exception(error)
                return future
            return super().submit(function, *arguments)

    widths = [*np.linspace(0.0101, 0.0129, 30).tolist(), 0.013, *np.linspace(0.0131, 0.02, 30).tolist()]
    found = compute(Garbled(), tiny_work(), widths)
    require_each_once(found, widths)
    (failed,) = [one for one in found if one.failure]
    assert widths[failed.point] == 0.013


def test_what_came_back_before_an_interruption_is_kept(tiny_work: Make) -> None:
    """Of chunks that are done, not of those that were cancelled or failed."""

    class Interrupted:
        slots, closed = 2, list[bool]()

        def __init__(self) -> None:
            self.inner, self.count = ThisProcess(), 0

        def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
            self.count += 1
            future: Future[Any] = Future()
            if self.count == 4:
                raise KeyboardInterrupt
            if self.count == 2:
                future.cancel()
            elif self.count == 3:
                future.set_exception(SimulationError("lost"))
            else:
                future = self.inner.submit(function, *arguments)
            return future

        def close(self, *, abandon: bool = False) -> None:
            self.closed.append(abandon)

    workers, found = Interrupted(), list[Outcome]()
    dispatch = Dispatch(
        workers,  # type: ignore[arg-type]
        tiny_work(),
        lambda point: {"belt.width": 0.01 + 0.001 * point},
        lambda outcomes, units: found.extend(outcomes),
        lambda: None,
    )
    with pytest.raises(KeyboardInterrupt):
        dispatch.run(range(8))
    assert [one.point for one in found] == [0]
    assert workers.closed == [True]


@pytest.mark.slow
def test_thousands_of_tiny_points_come_back_from_processes(tiny_work: Make) -> None:
    widths = np.linspace(0.0101, 0.02, 3000).tolist()
    require_each_once(compute(LocalProcesses(2), tiny_work(), widths), widths)


@pytest.mark.slow
def test_a_killed_process_loses_and_doubles_no_point(tiny_work: Make, tmp_path: Path) -> None:
    widths = [*np.linspace(0.0101, 0.0129, 10).tolist(), 0.013, *np.linspace(0.0131, 0.02, 10).tolist()]
    found = compute(LocalProcesses(2), tiny_work(kills=1), widths)
    require_each_once(found, widths)
    assert not any(one.failure for one in found)
    assert len(list(tmp_path.glob("killed-*"))) == 1


@pytest.mark.slow
def test_a_point_that_kills_each_of_its_processes_fails_alone(tiny_work: Make, tmp_path: Path) -> None:
    widths = [*np.linspace(0.0101, 0.0129, 10).tolist(), 0.013, *np.linspace(0.0131, 0.02, 10).tolist()]
    found = compute(LocalProcesses(2), tiny_work(kills=99), widths)
    require_each_once(found, widths)
    (failed,) = [one for one in found if one.failure]
    assert widths[failed.point] == 0.013
    assert "killed 3 times" in failed.failure
    assert len(list(tmp_path.glob("killed-*"))) == 3


def test_an_interruption_keeps_what_was_computed(tiny_work: Make) -> None:
    found: list[Outcome] = []

    def take(outcomes: list[Outcome], units: Mapping[str, str]) -> None:
        found.extend(outcomes)

    def tell() -> None:
        if len(found) > 3:
            raise KeyboardInterrupt

    dispatch = Dispatch(ThisProcess(), tiny_work(), lambda point: {"belt.width": 0.01 + 1e-4 * point}, take, tell)
    with pytest.raises(KeyboardInterrupt):
        dispatch.run(range(100))
    assert 3 < len(found) < 100


@pytest.mark.slow
def test_a_cluster_whose_worker_is_killed_loses_and_doubles_no_point(tiny_work: Make, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    widths = [*np.linspace(0.0101, 0.0129, 40).tolist(), 0.013, *np.linspace(0.0131, 0.02, 200).tolist()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # those of the cluster, whose worker is killed
        with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster:
            found = compute(DaskWorkers(cluster.scheduler_address), tiny_work(kills=1), widths)
    require_each_once(found, widths)
    assert not any(one.failure for one in found)
    assert len(list(tmp_path.glob("killed-*"))) == 1


@pytest.mark.slow
def test_a_cluster_that_goes_ends_the_study_with_what_came_back(tiny_work: Make) -> None:
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cluster = distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None)
        workers, found = DaskWorkers(cluster.scheduler_address), list[Outcome]()

        def take(outcomes: list[Outcome], units: Mapping[str, str]) -> None:
            found.extend(outcomes)
            cluster.close()

        dispatch = Dispatch(workers, tiny_work(seconds=0.2), lambda _: {"belt.width": 0.01}, take, lambda: None)
        with pytest.raises(SimulationError, match="to resume it"):
            dispatch.run(range(50))
    assert 0 < len(found) < 50


@pytest.mark.slow
def test_a_study_on_a_cluster_outlives_thirty_kills(
    drive: Drive, tiny_work: Make, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """A worker that computes is chosen at random and killed, with its results that were not fetched, 30 times.

    Every point has one row, with its own number. `LocalCluster` would leave out a worker for good that is not back 15 s
    after a loss, as one that is killed again; its deadline is put off.
    """
    distributed = pytest.importorskip("distributed")
    dask = pytest.importorskip("dask")
    work = tiny_work(seconds=0.1)
    register(work.analysis)
    widths = np.linspace(0.0131, 0.02, 300).round(7).tolist()
    plan = ParameterStudy(
        analysis=work.analysis.name,
        options=dict(work.options),
        number=[{"path": "belt.width", "values": widths}],
        results=["width"],
    )
    computed, rows, kills = tmp_path / "computed", tmp_path / "study.csv", list[int]()
    chance, over = random.Random(17), Event()

    def kill() -> None:
        """Kill one of those that have computed since the last kill, each time some more rows are there."""
        seen, goal = 0, 3
        while len(kills) < 30 and not over.wait(0.05):
            lines = computed.read_text(encoding="utf-8").splitlines() if computed.exists() else []
            done = len(rows.read_text(encoding="utf-8").splitlines()) if rows.exists() else 0
            alive = sorted({int(line.split()[1]) for line in lines[seen:]} - set(kills))
            if done >= goal and alive:
                kills.append(chance.choice(alive))
                with suppress(ProcessLookupError):
                    os.kill(kills[-1], signal.SIGKILL)
                seen, goal = len(lines), done + chance.randint(1, 15)

    with warnings.catch_warnings(), dask.config.set({"distributed.deploy.lost-worker-timeout": "1h"}):
        warnings.simplefilter("ignore")  # those of the cluster, whose workers are killed
        with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster:
            killer = Thread(target=kill)
            killer.start()
            found = study(plan, drive, scheduler=cluster.scheduler_address, output=tmp_path / "study.nc").dataset
            over.set()
            killer.join()
    assert len(kills) == 30
    assert found["width"].values.tolist() == widths
    assert not (found["failure"] != "").any()
    told = rows.read_text(encoding="utf-8").splitlines()[1:]
    assert sorted(int(row.partition(",")[0]) for row in told) == list(range(1, len(widths) + 1))
    assert len(computed.read_text(encoding="utf-8").splitlines()) > len(widths)  # some were lost, and computed again

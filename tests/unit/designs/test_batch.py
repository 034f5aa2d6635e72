"""Many simulations side by side: results, failures, interruption, killed processes, scripts without a guard."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from multiprocessing import active_children
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.designs import batch
from beltdyn.designs.batch import simulate_all
from beltdyn.designs.processes import Ending, Work
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, open_run, summarize
from beltdyn.solvers.run_progress import BatchProgress

Change = Callable[..., Drive]


@pytest.fixture
def soon() -> Iterator[Callable[[Callable[[], bool], Callable[[], None]], None]]:
    """Do something in another thread as soon as a condition holds."""
    threads: list[threading.Thread] = []

    def when(condition: Callable[[], bool], action: Callable[[], None]) -> None:
        def wait() -> None:
            while not condition():
                time.sleep(0.05)
            action()

        threads.append(threading.Thread(target=wait))
        threads[-1].start()

    yield when
    for thread in threads:
        thread.join()


def outputs(file: Path) -> int:
    """Number of outputs that a result file holds, even while it is written."""
    try:
        run = open_run(file)
    except Exception:
        return 0
    with run.dataset as dataset:
        return dataset.sizes["time"]


def status(file: Path) -> str:
    """Status of a result file; one that cannot be read is being written."""
    try:
        with open_run(file).dataset as dataset:
            return str(dataset.attrs["status"])
    except ModelError:
        return "running"


def test_nothing_to_do() -> None:
    told: list[BatchProgress] = []
    assert simulate_all({}, told.append) == {}
    assert told == [BatchProgress(0, 0, {})]


def test_an_ending_travels_between_processes(run: Run) -> None:
    ending = Ending("completed", summary=summarize(run))
    assert repr(pickle.loads(pickle.dumps(ending))) == repr(ending)  # in which NaN is as NaN


class OnePool:
    """In place of a pool of processes: what becomes of the drives that are submitted is laid out before."""

    plans: ClassVar[list[dict[str, str]]] = []
    """File -> "done", "begun" or "waiting" when a process is killed, or "interrupt" before; for each of the pools."""

    def __init__(self, jobs: int, begin: Callable[..., None], shared: tuple[Any, ...]) -> None:
        self.plan, (self.parts,), self.stops = self.plans.pop(0), shared, list[bool]()

    def submit(self, function: Callable[..., Ending], place: int, file: Path, _: Drive, work: Work) -> Future[Ending]:
        assert not work.overwrite
        future, fate = Future[Ending](), self.plan[file.name]
        if fate == "interrupt":
            raise KeyboardInterrupt
        if fate != "waiting":
            self.parts[place] = 0.0  # it is told that it began, and no more
        future.set_exception(BrokenPipeError()) if fate != "done" else future.set_result(Ending("completed"))
        return future

    def lost(self, error: BaseException | None) -> bool:
        return isinstance(error, BrokenPipeError)

    def close(self, *, stop: bool) -> None:
        self.stops.append(stop)


@pytest.mark.parametrize(
    ("plans", "expected"),
    [
        ([{"a": "done", "b": "begun", "c": "waiting"}, {"c": "done"}], ["completed", "failed", "completed"]),
        ([{"a": "waiting", "b": "done", "c": "waiting"}, {"a": "done", "c": "done"}], ["completed"] * 3),
        ([{"a": "waiting", "b": "waiting", "c": "waiting"}], ["failed"] * 3),
        ([{"a": "interrupt"}], ["not started"] * 3),
        ([{"a": "begun", "b": "done", "c": "waiting"}, {"c": "interrupt"}], ["failed", "completed", "not started"]),
    ],
)
def test_what_had_not_begun_when_a_process_was_killed_is_begun_again(
    drive: Drive, monkeypatch: pytest.MonkeyPatch, plans: list[dict[str, str]], expected: list[str]
) -> None:
    """What had begun has failed, even before its first step; where nothing had, no other attempt is of use."""
    monkeypatch.setattr(batch, "LocalProcesses", OnePool)
    monkeypatch.setattr(batch, "compile_ahead", lambda drive: None)
    monkeypatch.setattr(OnePool, "plans", list(plans))
    told = list[BatchProgress]()
    endings = simulate_all({Path(name): drive for name in "abc"}, told.append, jobs=2)
    assert {file.name: ending.status for file, ending in endings.items()} == dict(zip("abc", expected, strict=True))
    assert all("was killed" in ending.error for ending in endings.values() if ending.status == "failed")
    assert not OnePool.plans
    assert all(progress.total == 3 for progress in told)


def test_one_of_each_kind_of_kernels_comes_before_longer_runs(change: Change, monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes wait for each other where one compiles what the others need."""
    order = list[str]()

    def pool(drives: Any, *_: Any) -> tuple[dict[Path, Ending], bool]:
        order.extend(file.name for file, _ in drives)
        return {file: Ending("completed") for file, _ in drives}, True

    monkeypatch.setattr(batch, "_run_pool", pool)
    monkeypatch.setattr(batch, "compile_ahead", lambda drive: None)
    lengths = {"long": 0.03, "longest": 0.04, "short": 0.01}
    drives = {Path(name): change(simulation={"duration": time}) for name, time in lengths.items()}
    trusses = {"truss": 0.02, "short truss": 5e-3}
    drives |= {
        Path(name): change(belt={"discretization": "truss"}, simulation={"duration": time})
        for name, time in trusses.items()
    }
    simulate_all(drives)
    assert order == ["longest", "truss", "long", "short", "short truss"]


@pytest.mark.slow
def test_side_by_side_as_one_by_one(change: Change, failing: Drive, tmp_path: Path) -> None:
    """The same numbers as alone; a failure and a file that cannot be written leave the others alone."""
    (tmp_path / "folder.nc").mkdir()
    drives = {"short": change(), "fails": failing, "folder": change(), "long": change(simulation={"duration": 0.01})}
    told: list[BatchProgress] = []
    files = {name: tmp_path / f"{name}.nc" for name in drives}
    endings = simulate_all({str(files[name]): drive for name, drive in drives.items()}, told.append, jobs=2)

    assert list(endings) == list(files.values())
    statuses = [ending.status for ending in endings.values()]
    assert statuses == ["completed", "failed", "failed", "completed"]
    for name in ("short", "long"):
        alone, run = simulate(drives[name]), open_run(files[name])
        with run.dataset as dataset:
            np.testing.assert_array_equal(dataset.nodal_coordinates, alone.dataset.nodal_coordinates)
            told_of = endings[files[name]].summary
            assert told_of is not None
            assert told_of.spans == summarize(run).spans
    failed, unwritable = endings[files["fails"]], endings[files["folder"]]
    assert "fails at t = 0.002" in failed.error
    assert failed.summary is not None
    assert failed.summary.end == pytest.approx(2e-3)
    assert "folder.nc cannot be written" in unwritable.error
    assert unwritable.summary is None

    assert (told[0], told[-1]) == (BatchProgress(0, 4, {}), BatchProgress(4, 4, {}))
    assert all(len(progress.running) <= 2 for progress in told)
    assert all(0.0 <= part <= 1.0 for progress in told for part in progress.running.values())


@pytest.mark.slow
@pytest.mark.usefixtures("signal_defaults")
def test_an_interruption_keeps_what_was_computed(change: Change, tmp_path: Path, soon: Callable[..., None]) -> None:
    endless = change(simulation={"duration": 200.0, "output_interval": 0.01})
    one, two, three = (tmp_path / f"{name}.nc" for name in ("one", "two", "three"))
    soon(lambda: outputs(one) > 0 and outputs(two) > 0, lambda: os.kill(os.getpid(), signal.SIGINT))
    endings = simulate_all(dict.fromkeys((one, two, three), endless), jobs=2)
    assert [ending.status for ending in endings.values()] == ["interrupted", "interrupted", "not started"]
    for file in (one, two):
        summary = endings[file].summary
        assert summary is not None
        assert summary.status == "interrupted"
        assert 0 < summary.outputs == outputs(file) < 20_000
    assert not three.exists()


@pytest.mark.slow
def test_a_killed_process_spares_those_that_had_not_begun(
    change: Change, tmp_path: Path, soon: Callable[..., None]
) -> None:
    endless, short = change(simulation={"duration": 200.0, "output_interval": 0.01}), change()
    long, brief = tmp_path / "long.nc", tmp_path / "brief.nc"

    def kill() -> None:
        for child in active_children():
            child.kill()

    soon(lambda: outputs(long) > 0, kill)
    endings = simulate_all({brief: short, long: endless}, jobs=1)
    assert endings[brief].status == "completed"
    assert endings[long].status == "failed"
    assert "was killed" in endings[long].error
    assert outputs(long) > 0


@pytest.mark.slow
def test_processes_end_with_a_parent_that_was_killed(change: Change, tmp_path: Path) -> None:
    drive = change(simulation={"duration": 200.0, "output_interval": 0.01})
    (tmp_path / "drive.toml").write_text(drive.text, encoding="utf-8")
    program = "from beltdyn import load, simulate_all; simulate_all({'one.nc': load('drive.toml')})"
    parent = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path)
    file = tmp_path / "one.nc"
    while outputs(file) == 0:
        assert parent.poll() is None
        time.sleep(0.1)
    parent.kill()
    parent.wait()
    end = time.monotonic() + 60.0
    while status(file) == "running":
        assert time.monotonic() < end
        time.sleep(0.1)
    assert status(file) == "interrupted"
    assert 0 < outputs(file) < 20_000


@pytest.mark.slow
def test_a_script_needs_no_guard_and_is_not_run_again(change: Change, tmp_path: Path) -> None:
    """Processes inherit neither the script nor many threads, and leave the caller's settings alone."""
    (tmp_path / "drive.toml").write_text(change().text, encoding="utf-8")
    script = tmp_path / "script.py"
    script.write_text(
        "import os, sys\n"
        "from beltdyn import load, simulate_all\n"
        "print('begun')\n"
        "drive = load('drive.toml')\n"
        "endings = simulate_all({'a.nc': drive, 'b.nc': drive})\n"
        "print(*(ending.status for ending in endings.values()))\n"
        "print(sys.modules['__main__'].__file__, os.environ.get('OMP_NUM_THREADS'))\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    process = subprocess.run(
        [sys.executable, str(script)], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert process.stdout.splitlines() == ["begun", "completed completed", f"{script} None"]
    assert process.stderr == ""

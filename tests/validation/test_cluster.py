"""Studies on a Dask cluster as users have it: a scheduler and workers of their own, which come, go and are killed.

The commands are those of the documentation.  All results are compared with those of this process.
"""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from beltdyn.designs.study import study
from beltdyn.errors import ModelError
from beltdyn.model import ParameterStudy, dumps
from beltdyn.model.toml import read_study
from beltdyn.results import Result
from beltdyn.solvers.run_progress import Progress
from validation.published.cases import better, loaded_two_pulley

pytest.importorskip("distributed")

HEAD = """
drive = "drive.toml"
analysis = "{analysis}"
results = [{results}]

[options]
{options}

[[number]]
path = "belt.width"
values = {values}
"""
OPTIMIZATION = """
[[number]]
path = "belt.installed_tension"
least = "500 N"
largest = "700 N"

[goal]
result = "hub_load"

[[requirement]]
result = "slip_safety"
at_least = 2.0
"""
CALIBRATION = """
[[number]]
path = "belt.youngs_modulus"
least = "800 MPa"
largest = "1500 MPa"

[[measurement]]
table = "slip.csv"
"""
SLIPS = "driven torque [N m], pulley_slip[driven] [%]\n-15, 0.18\n-30, 0.37\n-45, 0.55\n"
KINDS = {
    "equilibrium": ("", '"tension", "hub_load"'),
    "steady_state": ("", '"efficiency", "slip_safety", "span_tension"'),
    "operating_map": ('speed = "600, 900 rpm"', '"largest(efficiency)", "smallest_safety", "hub_load"'),
    "optimize": ('study = "optimization.toml"\nmost = 3', '"goal_found", "best"'),
    "calibrate": ('study = "calibration.toml"', '"fitted", "residual_deviation"'),
}
"""Analysis -> options and results."""
MANY = 60
"""Points of a study that takes some seconds."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With the files of all studies."""
    drive = better(loaded_two_pulley(creep_rate_factor=1e6))
    drive = drive.replace(belt=drive.belt.replace(length=None, installed_tension=600.0))
    texts = {"drive": dumps(drive), "optimization": OPTIMIZATION, "calibration": CALIBRATION}
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    (tmp_path / "slip.csv").write_text(SLIPS, encoding="utf-8")
    return tmp_path


def written(folder: Path, analysis: str, values: str = '"24, 25, 26 mm"') -> Path:
    """The file of a study."""
    options, results = KINDS[analysis]
    file = folder / f"{analysis}.toml"
    file.write_text(HEAD.format(analysis=analysis, results=results, options=options, values=values), encoding="utf-8")
    return file


class Cluster:
    """A scheduler, and workers in folders of their own."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._processes, file = folder, list[subprocess.Popen[bytes]](), folder / "scheduler.json"
        self._start("scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(file))
        self._wait(file.exists)
        from distributed import Client

        with Client(scheduler_file=str(file), timeout=30) as client:
            self.address = client.scheduler.address

    def worker(self, **environment: str) -> subprocess.Popen[bytes]:
        """Start one."""
        return self._start(
            *("worker", self.address, "--nworkers", "1", "--nthreads", "1", "--no-nanny", "--no-dashboard"),
            **environment,
        )

    def _start(self, *words: str, **environment: str) -> subprocess.Popen[bytes]:
        own = self._folder / f"process-{len(self._processes)}"
        own.mkdir()
        command = [sys.executable, "-W", "ignore", "-m", "dask", *words]
        log = (own / "log").open("wb")
        self._processes.append(
            subprocess.Popen(command, cwd=own, env=os.environ | environment, stdout=log, stderr=subprocess.STDOUT)
        )
        log.close()
        return self._processes[-1]

    def _wait(self, ready: Callable[[], bool]) -> None:
        end = time.monotonic() + 60.0
        while not ready():
            assert time.monotonic() < end, "the scheduler does not start"
            time.sleep(0.05)

    def close(self) -> None:
        """End all."""
        for process in reversed(self._processes):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    yield cluster
    cluster.close()


def require_same(found: Result, expected: Result) -> None:
    assert not [text for text in found.dataset["failure"].values if text]
    names = [name for name in expected.dataset.data_vars if name not in ("seconds", "point_warnings")]
    for name in names:
        assert found.dataset[name].equals(expected.dataset[name]), name
        assert found.dataset[name].dtype.kind == "O" or np.isfinite(found.dataset[name].values).any(), name


def test_all_kinds_of_studies(folder: Path, cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    """By relative paths, of which the workers have other folders; files that an option names are found."""
    cluster.worker()
    cluster.worker()
    monkeypatch.chdir(folder)
    for analysis in KINDS:
        file = Path(written(folder, analysis).name)
        found = study(file, scheduler=cluster.address, output=f"{analysis}.nc")
        require_same(found, study(file, jobs=1))


def test_workers_come_go_and_are_killed(folder: Path, cluster: Cluster) -> None:
    """The study begins without any, and outlives the first one, which is killed, and the second, which ends."""
    file, rows = written(folder, "steady_state", f'"20..30 mm"\nsteps = {MANY}'), folder / "out.csv"
    phases, at_kill = list[str](), list[int]()

    def done() -> int:
        return rows.read_text(encoding="utf-8").count("\n") - 1 if rows.exists() else 0

    def conduct() -> None:
        while "no workers" not in phases:
            time.sleep(0.05)
        first = cluster.worker()
        while done() < 2:
            time.sleep(0.05)
        at_kill.append(done())
        os.kill(first.pid, signal.SIGKILL)
        second = cluster.worker()
        while done() < 6:
            time.sleep(0.05)
        second.terminate()
        cluster.worker()

    conductor = Thread(target=conduct, daemon=True)
    conductor.start()
    tell: Callable[[Progress], Any] = lambda progress: phases.append(progress.phase)  # noqa: E731
    found = study(file, scheduler=cluster.address, output=folder / "out.nc", progress=tell)
    conductor.join(10.0)
    assert not conductor.is_alive()
    assert at_kill[0] < MANY
    require_same(found, study(file, jobs=1))
    points = [line.partition(",")[0] for line in rows.read_text(encoding="utf-8").splitlines()[1:]]
    assert sorted(map(int, points)) == list(range(1, MANY + 1))


OTHER_VERSION = """
import importlib.metadata as metadata
_version = metadata.version
metadata.version = lambda name: "0.0.9" if name == "beltdyn" else _version(name)
"""


def test_workers_of_another_version_are_left_aside(folder: Path, cluster: Cluster, tmp_path: Path) -> None:
    """A study with none but those is refused; beside others they take no point."""
    (tmp_path / "sitecustomize.py").write_text(OTHER_VERSION, encoding="utf-8")
    cluster.worker(PYTHONPATH=str(tmp_path))
    file = written(folder, "steady_state", '"22, 23, 24, 25, 26, 27, 28 mm"')
    with pytest.raises(ModelError, match=r"no worker has beltdyn .*workers have 0\.0\.9"):
        study(file, scheduler=cluster.address)
    cluster.worker()
    _wait_for(cluster, 2)
    found = study(file, scheduler=cluster.address)
    require_same(found, study(file, jobs=1))


def test_files_that_workers_do_not_have_are_told(folder: Path, cluster: Cluster) -> None:
    """At each point, with the name of the file: `keep_files` and options need folders that workers share."""
    cluster.worker()
    given = read_study(written(folder, "optimize"), ParameterStudy)
    found = study(
        given.replace(drive=str(folder / "drive.toml"), options={"study": "/no/such/folder/optimization.toml"}),
        scheduler=cluster.address,
    )
    assert ["/no/such/folder/optimization.toml" in text for text in found.dataset["failure"].values] == [True] * 3


def _wait_for(cluster: Cluster, workers: int) -> None:
    from distributed import Client

    with Client(cluster.address, timeout=30) as client:
        client.wait_for_workers(workers, timeout=60)

"""Runs by name, of which some may have failed."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
import numpy as np
import xarray as xr

from beltdyn.analyses import Analysis
from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import analyse_all, simulate_all
from beltdyn.designs.processes import Ending, LocalProcesses
from beltdyn.errors import SimulationError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.atomic import make_folder
from beltdyn.results.schema import attribute
from beltdyn.solvers.run_progress import BatchProgress
from validation.paper.kept import open_kept

REPEATS = 2
"""How often a timed run is done, to see how its computing time varies."""

PAPER_RUN = Analysis("validation.paper.kept:paper_run", "Simulate a drive, and keep what the page needs.")
"""What is computed of each drive."""


class RunMissingError(KeyError):
    """A run that failed was asked for."""

    def __str__(self) -> str:
        return str(self.args[0])


class Runs(Mapping[str, Run]):
    """What was kept of runs by name; asking for one that failed raises `RunMissingError`.

    Iteration gives each run once: names of equal drives stand for one run.

    Parameters
    ----------
    kept : mapping
        Name -> what was kept of the run.
    drives : mapping
        Name -> drive.
    failures : mapping
        Name -> why there is none.
    same : mapping
        Name -> name of the run of an equal drive, which is in `kept` or `failures`.
    """

    def __init__(
        self,
        kept: Mapping[str, xr.Dataset],
        drives: Mapping[str, Drive],
        failures: Mapping[str, str],
        same: Mapping[str, str] | None = None,
    ) -> None:
        self._runs = {name: Run(dataset, drives[name]) for name, dataset in kept.items()}
        self._times = dict[str, FloatArray]()
        self._same = dict(same or {})
        self.failures = dict(failures)

    def __getitem__(self, name: str) -> Run:
        name = self.name_of(name)
        if name in self.failures:
            raise RunMissingError(f"the run {name} failed: {self.failures[name]}")
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def name_of(self, name: str) -> str:
        """Name under which the run of a drive is kept."""
        return self._same.get(name, name)

    def take_times(
        self,
        names: Iterable[str],
        folder: Path,
        progress: Callable[[BatchProgress], None] | None = None,
        repeats: int = REPEATS,
    ) -> None:
        """Take the processor times of some runs, side by side and in turns.

        A core is as busy in all of them, and a change of the machine's speed from turn to turn meets them all.

        Parameters
        ----------
        names : iterable of str
            Names of runs, each of which is timed once however often it is named.
        folder : Path
            Where the timed runs are written for a while.
        progress : callable, optional
            Told of the runs.
        repeats : int
            How often each is done.

        Raises
        ------
        SimulationError
            If a run fails.
        KeyboardInterrupt
            After Ctrl-C.
        """
        distinct = list(dict.fromkeys(map(self.name_of, names)))
        drives = {name: _without_outputs(self[name].drive) for name in distinct}
        times = np.zeros((repeats, len(drives)))
        for turn in range(repeats):

            def tell(batch: BatchProgress, before: int = turn * len(drives)) -> None:
                if progress is not None:
                    progress(BatchProgress(before + batch.done, times.size, batch.running, kind="timed runs"))

            times[turn] = _cpu_times(drives, folder, tell)
        self._times |= dict(zip(distinct, times.T, strict=True))

    def cpu_times(self, names: Iterable[str]) -> dict[str, FloatArray]:
        """Give the processor time of each repetition, without outputs on the way, s, shape (repeats,), by name."""
        return {name: self._times[self.name_of(name)] for name in names}


def _without_outputs(drive: Drive) -> Drive:
    """The same drive with outputs at the beginning and the end only."""
    settings = drive.simulation
    return drive.replace(simulation=settings.replace(output_interval=settings.duration, field_interval=None))


def _cpu_times(drives: Mapping[str, Drive], folder: Path, progress: Callable[[BatchProgress], None]) -> list[float]:
    """Processor times of runs side by side, s."""
    with TemporaryDirectory(dir=folder) as place:
        paths = {Path(place) / f"{name}.nc": drive for name, drive in drives.items()}
        endings = simulate_all(paths, progress)
        _end_if_interrupted(endings)
        for ending in endings.values():
            if ending.error:
                raise SimulationError(ending.error)
        return [_cpu_time(path) for path in paths]


def _cpu_time(path: Path) -> float:
    """Processor time of a run, s."""
    with h5py.File(path, "r") as file:
        return attribute(file, "cpu_time", np.nan)


def _end_if_interrupted(endings: Mapping[Path, Ending]) -> None:
    """End all after Ctrl-C."""
    if any(ending.status in ("interrupted", "not started") for ending in endings.values()):
        raise KeyboardInterrupt


def _with_fields(drive: Drive) -> Drive:
    """The same drive with fields along the belt at every output."""
    settings = drive.simulation
    return drive.replace(simulation=settings.replace(field_interval=settings.output_interval))


def run_all(
    drives: Mapping[str, Drive],
    folder: Path,
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
) -> Runs:
    """Simulate drives side by side, equal ones once.

    Parameters
    ----------
    drives : mapping
        Name -> drive.
    folder : Path
        Where to write, for each drive and named after it (of equal ones the first), its drive file and what the page
        keeps of its run; made if need be.
    progress : callable, optional
        Told of the runs.
    jobs : int, optional
        How many at a time; by default as many as there are cores.

    Returns
    -------
    Runs
        Those that were completed, and why others were not.

    Raises
    ------
    ModelError
        If the folder cannot be made.
    KeyboardInterrupt
        After Ctrl-C; files that are there hold what was computed.
    """
    make_folder(folder)
    first = dict[str, str]()
    same = {name: first.setdefault(drive.text, name) for name, drive in drives.items()}
    distinct = {name: drives[name] for name in first.values()}
    for name, drive in distinct.items():
        (folder / f"{name}.toml").write_text(drive.text, encoding="utf-8")
    paths = {name: folder / f"{name}.nc" for name in distinct}
    wanted = {paths[name]: _with_fields(drive) for name, drive in distinct.items()}
    endings = analyse_all(PAPER_RUN, wanted, progress, jobs)
    _end_if_interrupted(endings)
    failures = {name: endings[path].error for name, path in paths.items() if endings[path].error}
    kept = _open_all({name: path for name, path in paths.items() if name not in failures}, jobs)
    return Runs(kept, drives, failures, same)


def _open_all(paths: Mapping[str, Path], jobs: int | None) -> dict[str, xr.Dataset]:
    """Read files side by side: h5netcdf takes 0.2 s for one."""
    workers = LocalProcesses(jobs)
    try:
        waiting = {name: workers.submit(open_kept, path) for name, path in paths.items()}
        return {name: future.result() for name, future in waiting.items()}
    finally:
        workers.close()

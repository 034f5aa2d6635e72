"""Runs by name, of which some may have failed."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import simulate_all
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.atomic import make_folder
from beltdyn.solvers.run_progress import BatchProgress
from beltdyn.transient.simulate import simulate
from validation.paper.kept import keep, open_kept

REPEATS = 3
"""How often a run is done again to see how its computing time varies."""


class RunMissingError(KeyError):
    """A run that failed was asked for."""

    def __str__(self) -> str:
        return str(self.args[0])


class Runs(Mapping[str, Run]):
    """What was kept of runs by name; asking for one that failed raises `RunMissingError`.

    Parameters
    ----------
    paths : mapping
        Name -> file with what was kept.
    drives : mapping
        Name -> drive.
    failures : mapping
        Name -> why there is none.
    progress : callable, optional
        Told of runs that are timed again.
    """

    def __init__(
        self,
        paths: Mapping[str, Path],
        drives: Mapping[str, Drive],
        failures: Mapping[str, str],
        progress: Callable[[BatchProgress], None] | None = None,
    ) -> None:
        self._progress = progress
        self._runs = {name: Run(open_kept(path), drives[name]) for name, path in paths.items()}
        self.failures = dict(failures)

    def __getitem__(self, name: str) -> Run:
        if name in self.failures:
            raise RunMissingError(f"the run {name} failed: {self.failures[name]}")
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def cpu_times(self, names: Sequence[str], repeats: int = REPEATS) -> dict[str, FloatArray]:
        """Time some runs again, one at a time and in turns, so that a change of the machine's speed meets them all.

        Parameters
        ----------
        names : sequence of str
            Names of runs.
        repeats : int
            How often each is done.

        Returns
        -------
        dict
            Name -> processor time of each repetition, without outputs on the way, s, shape (repeats,).

        Raises
        ------
        KeyboardInterrupt
            After Ctrl-C.
        """
        drives = [_without_outputs(self[name].drive) for name in names]
        times = np.zeros(repeats * len(drives))
        for number in range(times.size):
            if self._progress is not None:
                self._progress(BatchProgress(number, times.size, {Path(names[number % len(drives)]): 0.0}))
            times[number] = _cpu_time(drives[number % len(drives)])
        return dict(zip(names, times.reshape(repeats, -1).T, strict=True))


def _without_outputs(drive: Drive) -> Drive:
    """The same drive with outputs at the beginning and the end only."""
    settings = drive.simulation
    return drive.replace(simulation=settings.replace(output_interval=settings.duration, field_interval=None))


def _cpu_time(drive: Drive) -> float:
    """Processor time of a run, s."""
    run = simulate(drive)
    if run.status != "completed":
        raise KeyboardInterrupt
    return float(run.dataset.attrs["cpu_time"])


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
    """Simulate drives side by side.

    Parameters
    ----------
    drives : mapping
        Name -> drive.
    folder : Path
        Where to write, for each drive and named after it, its drive file and what the page keeps of its run; made if
        need be.
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
    for name, drive in drives.items():
        (folder / f"{name}.toml").write_text(drive.text, encoding="utf-8")
    paths = {name: folder / f"{name}.nc" for name in drives}
    wanted = {paths[name]: _with_fields(drive) for name, drive in drives.items()}
    endings = simulate_all(wanted, progress, jobs, finish=keep)
    if any(ending.status in ("interrupted", "not started") for ending in endings.values()):
        raise KeyboardInterrupt
    failures = {name: endings[path].error for name, path in paths.items() if endings[path].error}
    return Runs({name: path for name, path in paths.items() if name not in failures}, drives, failures, progress)

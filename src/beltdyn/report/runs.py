"""Runs by name, of which some may have failed."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from beltdyn.model import Drive
from beltdyn.results import Run, open_run
from beltdyn.results.atomic import make_folder
from beltdyn.solve import BatchProgress, simulate_all


class RunMissingError(KeyError):
    """A run that failed was asked for."""

    def __str__(self) -> str:
        return str(self.args[0])


class Runs(Mapping[str, Run]):
    """Runs by name; asking for one that failed raises `RunMissingError`.

    Parameters
    ----------
    paths : mapping
        Name -> result file.
    failures : mapping
        Name -> why there is none.
    """

    def __init__(self, paths: Mapping[str, Path], failures: Mapping[str, str]) -> None:
        self._runs = {name: open_run(path) for name, path in paths.items()}
        self.failures = dict(failures)

    def __getitem__(self, name: str) -> Run:
        if name in self.failures:
            raise RunMissingError(f"the run {name} failed: {self.failures[name]}")
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def close(self) -> None:
        """Close the result files."""
        for run in self._runs.values():
            run.dataset.close()


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
        Where to write the result files, named after the drives; made if need be.
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
        After Ctrl-C; the result files hold what was computed.
    """
    make_folder(folder)
    paths = {name: folder / f"{name}.nc" for name in drives}
    endings = simulate_all({paths[name]: drive for name, drive in drives.items()}, progress, jobs)
    if any(ending.status in ("interrupted", "not started") for ending in endings.values()):
        raise KeyboardInterrupt
    failures = {name: endings[path].error for name, path in paths.items() if endings[path].error}
    return Runs({name: path for name, path in paths.items() if name not in failures}, failures)

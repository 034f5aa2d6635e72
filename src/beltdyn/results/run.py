"""A run: its dataset, the drive it belongs to and how it ended."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.model import Drive, loads
from beltdyn.results.checks import find_warnings
from beltdyn.results.dataset import open_dataset
from beltdyn.results.resolution import Resolution, estimate_resolution


@dataclass(frozen=True, eq=False)
class Run:
    """What a simulation gave.

    Attributes
    ----------
    dataset : xarray.Dataset
        Every recorded variable with its units; see `beltdyn.results.VARIABLES`.
    drive : Drive
        The drive that was simulated.
    path : Path or None
        The result file, or None for a run in memory.
    """

    dataset: xr.Dataset = field(repr=False)
    drive: Drive = field(repr=False)
    path: Path | None = None

    @property
    def status(self) -> str:
        """How the run ended: "completed", "interrupted", "failed", or "running" if its end was not recorded."""
        return str(self.dataset.attrs["status"])

    @cached_property
    def warnings(self) -> list[str]:
        """What a reader of the results has to know; empty when all is well."""
        return find_warnings(self.dataset, self.drive)

    @cached_property
    def resolution(self) -> Resolution:
        """How well the mesh resolves tension and contact.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        self.require_output()
        return estimate_resolution(self.dataset, self.drive)

    def require_output(self) -> None:
        """Make sure that there is something to look at.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        if self.dataset.sizes["time"] == 0:
            raise ModelError("the run ended before its first output: there is nothing to show. Run it again.")


def open_run(path: Path | str) -> Run:
    """Open a result file; values are read when they are used.

    Parameters
    ----------
    path : Path or str
        A file written by `FileRecorder`, finished or not.

    Returns
    -------
    Run
        The run with its complete outputs.

    Raises
    ------
    ModelError
        If the file cannot be read or is not a result of beltdyn.
    """
    path = Path(path)
    dataset = open_dataset(path)
    return Run(dataset, loads(dataset.attrs["drive"], base=path.parent), path)

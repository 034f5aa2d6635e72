"""Recorders take outputs as a simulation goes, into memory or into a file."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import BeltdynError
from beltdyn.results import netcdf
from beltdyn.results.atomic import atomic_path, unwritable
from beltdyn.results.dataset import build_dataset, checked_chunk, open_dataset
from beltdyn.results.layout import Layout
from beltdyn.results.schema import TIMES

if TYPE_CHECKING:
    import xarray as xr

Chunk = Mapping[str, NDArray[Any]]
Status = Literal["running", "completed", "interrupted", "failed"]


class Recorder(Protocol):
    """Takes outputs as a simulation goes."""

    def append(self, chunk: Chunk) -> None:
        """Take outputs.

        Parameters
        ----------
        chunk : mapping
            An array for every name in `Layout.recorded`, each with one row for each new output along its first
            dimension, ``time`` or ``field_time``.

        Raises
        ------
        ValueError
            If a name is missing or unknown, or a shape is wrong.
        """

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Take the end of the simulation.

        Parameters
        ----------
        status : {"completed", "interrupted", "failed"}
            How it ended.
        attributes : mapping
            Global attributes known by now: the solver's statistics.
        """

    def dataset(self) -> "xr.Dataset":
        """Give what has been recorded so far.

        Returns
        -------
        xarray.Dataset
            The dataset.
        """


class MemoryRecorder:
    """Keeps outputs in memory.

    Parameters
    ----------
    layout : Layout
        Names and reference coordinates of what is recorded.
    attributes : mapping
        Global attributes of the dataset.
    """

    def __init__(self, layout: Layout, attributes: Mapping[str, Any]) -> None:
        self._layout = layout
        self._attributes = {**attributes, "status": "running"}
        self._chunks = [checked_chunk(layout, _no_outputs(layout))]

    def append(self, chunk: Chunk) -> None:
        """Take outputs; see `Recorder.append`."""
        arrays = checked_chunk(self._layout, chunk)
        self._chunks.append({name: array.copy() for name, array in arrays.items()})

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Take the end of the simulation; see `Recorder.close`."""
        self._attributes |= {**attributes, "status": status}

    def dataset(self) -> "xr.Dataset":
        """Give what has been recorded so far; see `Recorder.dataset`."""
        arrays = {name: np.concatenate([chunk[name] for chunk in self._chunks]) for name in self._layout.recorded}
        return build_dataset(self._layout, arrays, self._attributes)


class FileRecorder:
    """Writes outputs to a NetCDF4 file, which is closed and readable between any two of them.

    Parameters
    ----------
    path : Path or str
        The file; one that exists is replaced.
    layout : Layout
        Names and reference coordinates of what is recorded.
    attributes : mapping
        Global attributes of the dataset.

    Raises
    ------
    ModelError
        If the file cannot be written.
    """

    def __init__(self, path: Path | str, layout: Layout, attributes: Mapping[str, Any]) -> None:
        self.path = Path(path)
        self._layout = layout
        self._outputs = dict.fromkeys(TIMES, 0)
        with atomic_path(self.path) as temporary:
            netcdf.create(temporary, layout, {**attributes, "status": "running"})

    def append(self, chunk: Chunk) -> None:
        """Take outputs; see `Recorder.append`.

        Raises
        ------
        ValueError
            If a name is missing or unknown, or a shape is wrong.
        BeltdynError
            If the file can no longer be written.
        """
        arrays = checked_chunk(self._layout, chunk)
        try:
            netcdf.append(self.path, self._outputs, arrays)
        except OSError as error:
            raise BeltdynError(unwritable(self.path, error)) from error
        for name in TIMES:
            self._outputs[name] += len(arrays[name])

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Take the end of the simulation; see `Recorder.close`.

        Raises
        ------
        BeltdynError
            If the file can no longer be written.
        """
        try:
            netcdf.finish(self.path, self._outputs, {**attributes, "status": status})
        except OSError as error:
            raise BeltdynError(unwritable(self.path, error)) from error

    def dataset(self) -> "xr.Dataset":
        """Give what has been recorded so far, read when it is used; see `Recorder.dataset`."""
        return open_dataset(self.path)


def _no_outputs(layout: Layout) -> dict[str, NDArray[Any]]:
    return {name: np.empty(layout.shape(variable, 0)) for name, variable in layout.recorded.items()}

"""Recorders of outputs during a simulation, in memory or in a file."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import LostOutputError, ModelError, OutputError
from beltdyn.results import netcdf
from beltdyn.results.atomic import OutputLock, atomic_path, require_replaceable, target_of, unreadable, unwritable
from beltdyn.results.dataset import build_dataset, checked_outputs, is_result, open_dataset, require_intact
from beltdyn.results.layout import Layout
from beltdyn.results.schema import TIMES

if TYPE_CHECKING:
    import xarray as xr

Outputs = Mapping[str, NDArray[Any]]
Status = Literal["running", "completed", "interrupted", "failed"]


def status_after(error: type[BaseException] | None) -> Status:
    """Tell how work ended that an error of this type, or none, has left."""
    if error is None:
        return "completed"
    return "interrupted" if issubclass(error, KeyboardInterrupt) else "failed"


class Recorder(Protocol):
    """Records outputs during a simulation."""

    def revise(self, layout: Layout, attributes: Mapping[str, Any]) -> None:
        """Restart with other coordinates and attributes, before the first outputs."""

    def append(self, outputs: Outputs) -> None:
        """Append outputs."""

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Finish the recording."""

    def dataset(self) -> "xr.Dataset":
        """Give the outputs recorded so far."""

    @property
    def file(self) -> Path | None:
        """The file that holds outputs; None before the first of them, and in memory."""


class MemoryRecorder:
    """Records outputs in memory.

    Parameters
    ----------
    layout : Layout
        Names and reference coordinates of what is recorded.
    attributes : mapping
        Global attributes of the dataset.
    """

    def __init__(self, layout: Layout, attributes: Mapping[str, Any]) -> None:
        self.revise(layout, attributes)
        self._chunks = [checked_outputs(layout, _no_outputs(layout))]

    def revise(self, layout: Layout, attributes: Mapping[str, Any]) -> None:
        """Restart; see `Recorder.revise`."""
        self._layout, self._attributes = layout, {**attributes, "status": "running"}

    def append(self, outputs: Outputs) -> None:
        """Append outputs; see `Recorder.append`."""
        arrays = checked_outputs(self._layout, outputs)
        self._chunks.append({name: array.copy() for name, array in arrays.items()})

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Finish the recording; see `Recorder.close`."""
        self._attributes |= {**attributes, "status": status}

    def dataset(self) -> "xr.Dataset":
        """Give the outputs recorded so far; see `Recorder.dataset`."""
        arrays = {name: np.concatenate([chunk[name] for chunk in self._chunks]) for name in self._layout.recorded}
        return build_dataset(self._layout, arrays, self._attributes)

    @property
    def file(self) -> None:
        """Always None; see `Recorder.file`."""


class FileRecorder:
    """Writes outputs to a NetCDF4 file, which is closed and readable between outputs.

    No other recorder can write to that file until this one is closed.

    Parameters
    ----------
    path : Path or str
        The file; an existing result file is replaced once the first outputs are complete.
    layout : Layout
        Names and reference coordinates of what is recorded.
    attributes : mapping
        Global attributes of the dataset.
    overwrite : bool
        Replace any regular file.

    Raises
    ------
    ModelError
        If the file cannot be written, is being written by another run, or would replace a file that is not a result.
    """

    def __init__(
        self, path: Path | str, layout: Layout, attributes: Mapping[str, Any], overwrite: bool = False
    ) -> None:
        self.path, self._overwrite = Path(path), overwrite
        self._target = target_of(self.path)
        self._file: netcdf.GrowingFile | None = None
        self.revise(layout, attributes)
        require_replaceable(self.path, is_result, overwrite)
        try:
            self._lock = OutputLock(self._target)
        except OSError as error:
            raise ModelError(unwritable(self.path, error)) from error

    @classmethod
    def resumed(cls, path: Path, layout: Layout, counts: Mapping[str, int]) -> Self:
        """Resume a file whose writer was interrupted or killed, dropping later outputs."""
        made = cls.__new__(cls)
        made.path, made._target, made._layout, made._attributes = path, target_of(path), layout, {}
        try:
            made._lock = OutputLock(made._target)
        except OSError as error:
            raise ModelError(unwritable(path, error)) from error
        try:
            with made._lock.used(), atomic_path(path, is_result) as temporary:
                require_intact(made._target)
                made._file = netcdf.copied(made._target, temporary, layout, counts, str(made._lock.file))
        except (OSError, KeyError, ValueError) as error:
            made._lock.release()
            raise ModelError(unreadable(path, error)) from error
        except BaseException:
            made._lock.release()
            raise
        return made

    def revise(self, layout: Layout, attributes: Mapping[str, Any]) -> None:
        """Restart; see `Recorder.revise`."""
        self._layout, self._attributes = layout, {**attributes, "status": "running"}

    def append(self, outputs: Outputs) -> None:
        """Append outputs; see `Recorder.append`."""
        arrays = checked_outputs(self._layout, outputs)
        if self._file is None:
            if any(len(arrays[name]) for name in TIMES):
                self._file = self._begin(arrays)
            return
        try:
            self._file.append(self._target, arrays)
        except OSError as error:
            raise self._error(error) from error

    def _begin(self, arrays: Mapping[str, NDArray[Any]]) -> netcdf.GrowingFile:
        """Make the file with its first outputs, and let it take the place of an earlier one."""
        try:
            with self._lock.used(), atomic_path(self.path, is_result, self._overwrite) as temporary:
                file = netcdf.GrowingFile(temporary, self._layout, self._attributes, str(self._lock.file))
                file.append(temporary, arrays)
        except ModelError as error:
            raise OutputError(str(error)) from error
        return file

    def close(self, status: Status, attributes: Mapping[str, Any]) -> None:
        """Finish the recording; see `Recorder.close`. Without outputs there is no file, or an earlier one."""
        self._attributes |= {**attributes, "status": status}
        try:
            if self._file is not None:
                self._file.finish(self._target, {**attributes, "status": status})
        except OSError as error:
            raise self._error(error) from error
        finally:
            self._lock.release()

    def _error(self, error: OSError) -> OutputError:
        """Why the file can no longer be written."""
        if isinstance(error, FileNotFoundError | netcdf.ReplacedError):
            return LostOutputError(
                f"{self.path} was removed or replaced while the run was writing it: the results are lost. "
                "Run the drive again, and do not touch the file until the run has ended."
            )
        return OutputError(unwritable(self.path, error))

    def dataset(self) -> "xr.Dataset":
        """Give the outputs recorded so far, read lazily; see `Recorder.dataset`."""
        if self._file is None:
            return build_dataset(self._layout, _no_outputs(self._layout), self._attributes)
        return open_dataset(self.path)

    @property
    def file(self) -> Path | None:
        """The file, once it holds outputs; see `Recorder.file`."""
        return None if self._file is None else self.path


def _no_outputs(layout: Layout) -> dict[str, NDArray[Any]]:
    return {name: np.empty(layout.shape(variable, 0)) for name, variable in layout.recorded.items()}

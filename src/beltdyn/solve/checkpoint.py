"""Checkpoints of a run: all that its next step depends on, in a file beside the results, for going on after a kill.

A checkpoint is read by the version that wrote it, on the same kernels.  It is a pickle of records, arrays and parts of
a drive; nothing else is taken out of it, so that a file of others runs no code.
"""

import io
import pickle
import time
import warnings
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.kernel.cache import PACKAGE, source_hash
from beltdyn.model import Drive
from beltdyn.results.atomic import atomic_path
from beltdyn.signals import uninterrupted
from beltdyn.solve.integrators.generalized_alpha import AlphaIntegration
from beltdyn.solve.observation.recording import Recording

_HEAD = "beltdyn checkpoint"
_LONGEST_HEAD = 200
_LIBRARY = frozenset(
    {
        *(("builtins", name) for name in ("set", "frozenset", "slice", "range", "complex", "bytearray", "object")),
        *(("collections", name) for name in ("deque", "OrderedDict")),
        *(("pathlib", name) for name in ("Path", "PosixPath", "WindowsPath")),
        *(("numpy", name) for name in ("ndarray", "dtype", "record", "void", "recarray")),
        *(("numpy.rec", name) for name in ("record", "recarray")),
        *(("numpy._core.multiarray", name) for name in ("_reconstruct", "scalar")),
        *(("numpy.core.multiarray", name) for name in ("_reconstruct", "scalar")),
        ("numpy._core.numeric", "_frombuffer"),
        ("numpy.core.numeric", "_frombuffer"),
        ("types", "MappingProxyType"),
        ("beltdyn.model.drive", "_from_text"),
    }
)
"""What a checkpoint may hold beside classes of beltdyn: the last makes a drive of its text."""


class CheckpointWarning(UserWarning):
    """A checkpoint could not be written; the run goes on."""


@dataclass(frozen=True)
class Checkpoint:
    """A run on its way."""

    drive: Drive
    """As it was given."""
    integration: AlphaIntegration
    recording: dict[str, Any]
    """From `Recording.keep`."""
    compare_steady: bool


class Keeper:
    """Writes checkpoints of a run now and then.

    Parameters
    ----------
    path
        The result file; None for a run in memory, which has no checkpoints.
    every
        Computing time between two of them, s.
    drive
        As it was given.
    compare_steady
        As for `simulate`.
    resumes
        Whether a checkpoint that is there is of this run, and not of an earlier one.
    """

    def __init__(
        self, path: Path | None, every: float, drive: Drive, compare_steady: bool, *, resumes: bool = False
    ) -> None:
        self._path, self._every, self._own = path, every, resumes
        self._drive, self._compare = drive, compare_steady
        self._last = time.perf_counter()
        self._warned = False

    def look(self, recording: Recording, integration: AlphaIntegration) -> None:
        """Write a checkpoint if it is time; what is on its way is complete.

        One of an earlier run is removed as soon as the results of that are replaced. A checkpoint that cannot be
        written is tried again when the next one is due, and the one before stays; the first time a
        `CheckpointWarning` says so.
        """
        if self._path is None:
            return
        with uninterrupted():
            kept = recording.keep() if time.perf_counter() - self._last > self._every else None
            if recording.file is None:
                return
            if not self._own:
                self.remove()
                self._own = True
            if kept is not None:
                self._write(checkpoint_file(self._path), Checkpoint(self._drive, integration, kept, self._compare))
                self._last = time.perf_counter()

    def _write(self, path: Path, point: Checkpoint) -> None:
        """Write a checkpoint, or warn once that it cannot be written."""
        try:
            write_checkpoint(path, point)
        except ModelError as error:
            if self._warned:
                return
            self._warned = True
            since = "the checkpoint before it" if is_checkpoint(path) else "its beginning"
            warnings.warn(
                f"the run goes on without this checkpoint: {error} Results are not touched; but if the run is "
                f"interrupted or killed now, it goes on from {since}. A checkpoint is tried again every "
                f"{self._every:g} s.",
                CheckpointWarning,
                stacklevel=4,
            )

    def remove(self) -> None:
        """Remove the checkpoint, of a run that is complete or of an earlier one."""
        path = None if self._path is None else checkpoint_file(self._path)
        if path is not None and is_checkpoint(path):
            with suppress(OSError):
                path.unlink(missing_ok=True)


def checkpoint_file(path: Path) -> Path:
    """The checkpoint of a result file, beside it."""
    return path.with_name(f"{path.stem}.checkpoint")


def write_checkpoint(path: Path, point: Checkpoint) -> None:
    """Write a checkpoint.

    Parameters
    ----------
    path
        The file; an earlier checkpoint there is replaced when the new one is complete.
    point
        The run.

    Raises
    ------
    ModelError
        If it cannot be written, or would replace a file that is no checkpoint.
    """
    with atomic_path(path, is_checkpoint) as temporary, temporary.open("wb") as file:
        file.write(f"{_HEAD} {_made_by()}\n".encode())
        pickle.dump(point, file, protocol=5)


def read_checkpoint(path: Path) -> Checkpoint:
    """Read a checkpoint.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    ModelError
        If there is none, it was written by another version, or is damaged.
    """
    try:
        with path.open("rb") as file:
            head, content = file.readline(_LONGEST_HEAD), file.read()
    except OSError as error:
        raise ModelError(
            f"there is no checkpoint {path} to go on from: the run is complete, ended before the first one, or is a "
            "run-up, which writes none. Run the drive again, or begin another run where this one ended, by "
            "simulation.start = { file = ... }."
        ) from error
    made_by = head.decode(errors="replace").removeprefix(_HEAD).strip()
    if made_by != _made_by():
        raise ModelError(
            f"{path} was not written by this version of beltdyn ({version('beltdyn')}), which goes on with its own "
            "runs alone. Install the version that began the run, or run the drive again."
        )
    try:
        point = _Reader(io.BytesIO(content)).load()
    except Exception as error:  # a damaged pickle raises many unrelated types
        raise ModelError(f"{path} is damaged ({type(error).__name__}: {error}). Run the drive again.") from error
    if not isinstance(point, Checkpoint):
        raise ModelError(f"{path} is no checkpoint of a run. Run the drive again.")
    return point


def is_checkpoint(path: Path) -> bool:
    """Tell whether a file is a checkpoint of beltdyn."""
    with suppress(OSError), path.open("rb") as file:
        return file.read(len(_HEAD)) == _HEAD.encode()
    return False


def _made_by() -> str:
    """What tells apart versions whose runs go on differently."""
    return f"{version('beltdyn')} {source_hash(PACKAGE)}"


class _Reader(pickle.Unpickler):
    """Takes classes of beltdyn, and arrays."""

    def find_class(self, module: str, name: str) -> Any:
        """A class by its name."""
        found = super().find_class(module, name) if module.startswith("beltdyn.") else None
        if isinstance(found, type):
            return found
        if (module, name) in _LIBRARY:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} has no place in a checkpoint")

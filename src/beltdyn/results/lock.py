"""One writer for a file at a time."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

from filelock import FileLock, Timeout

from beltdyn.errors import ModelError
from beltdyn.parts.text_file import open_file
from beltdyn.results.checksums import find_checksums

_OURS: ContextVar[frozenset[Path]] = ContextVar("_OURS", default=frozenset())
"""Locks that the caller holds, and what it calls need not take."""


class OutputLock:
    """A lock on a file, which the operating system takes back from a process that is killed.

    It lies in a file beside it, ``.NAME.lock``, which is removed when the lock is given back.

    Parameters
    ----------
    path : Path
        The file, without links on the way to it; by a hard link it is the same file.
    patience : float
        How long to wait for whoever holds the lock, s.

    Raises
    ------
    ModelError
        If another one holds the lock.
    OSError
        If there is no such folder, or no writing in it.
    """

    def __init__(self, path: Path, patience: float = 0.0) -> None:
        self.file = lock_file(path)
        self._lock = FileLock(self.file, timeout=patience, thread_local=False)
        if self.file in _OURS.get():
            return
        if not path.parent.is_dir():  # the lock would make it
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        try:
            self._lock.acquire()
            if _is_written_by_another_name(path):
                self.release()
                raise Timeout(str(path))
        except Timeout as error:
            raise ModelError(
                f"{path} is being written by another run; both would lose their results. Wait until it has ended, or "
                "choose another file."
            ) from error

    @contextmanager
    def used(self) -> Iterator[None]:
        """Let what is called meanwhile write to the file."""
        before = _OURS.set(_OURS.get() | {self.file})
        try:
            yield
        finally:
            _OURS.reset(before)

    def release(self) -> None:
        """Give the lock back, once or more often."""
        if self._lock.is_locked:
            with suppress(PermissionError):  # Windows removes it itself, when it is no longer locked
                self.file.unlink(missing_ok=True)
            self._lock.release()


@contextmanager
def locked(path: Path, patience: float = 0.0) -> Iterator[None]:
    """Hold the lock of a file, unless the caller does; parameters and errors as of `OutputLock`."""
    lock = OutputLock(path, patience)
    try:
        with lock.used():
            yield
    finally:
        lock.release()


def lock_file(path: Path) -> Path:
    """The file that is there while a run writes a result, and after a run that was killed.

    Parameters
    ----------
    path : Path
        The result file.

    Returns
    -------
    Path
        In the same folder.
    """
    return path.with_name(f".{path.name}.lock")


def _is_written_by_another_name(path: Path) -> bool:
    """Whether a file that has hard links grows under another name: it tells who has locked it."""
    with suppress(OSError, ValueError):
        if path.stat().st_nlink > 1:
            with open_file(path) as file:
                found = find_checksums(file)
            return found is not None and bool(found.owner) and _is_held(Path(found.owner))
    return False


def _is_held(file: Path) -> bool:
    """Whether a lock is held; no other file than a lock is touched."""
    if not (file.name.startswith(".") and file.suffix == ".lock" and file.is_file() and not file.stat().st_size):
        return False
    try:
        with FileLock(file, timeout=0, thread_local=False):
            return False
    except Timeout:
        return True

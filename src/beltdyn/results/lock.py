"""One writer for a result file at a time."""

import errno
import os
from contextlib import suppress
from pathlib import Path

from filelock import FileLock, Timeout

from beltdyn.errors import ModelError


class OutputLock:
    """A lock on a result file, which the operating system takes back from a process that is killed.

    It lies in a file beside the result, ``.NAME.lock``, which is removed when the lock is given back.

    Parameters
    ----------
    path : Path
        The result file.

    Raises
    ------
    ModelError
        If another run holds the lock.
    OSError
        If there is no such folder, or no writing in it.
    """

    def __init__(self, path: Path) -> None:
        if not path.parent.is_dir():  # the lock would make it
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        self._file = lock_file(path)
        self._lock = FileLock(self._file, timeout=0, thread_local=False)
        try:
            self._lock.acquire()
        except Timeout as error:
            raise ModelError(
                f"{path} is being written by another run, and both would lose their results. Wait until it has ended, "
                "or choose another file."
            ) from error

    def release(self) -> None:
        """Give the lock back, once or more often."""
        if self._lock.is_locked:
            with suppress(PermissionError):  # Windows removes it itself, when it is no longer locked
                self._file.unlink(missing_ok=True)
            self._lock.release()


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

"""Atomic writing of files that replace only files of beltdyn."""

import errno
import os
import re
import secrets
import stat
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

from filelock import FileLock, Timeout

from beltdyn.errors import ModelError
from beltdyn.parts.text_file import open_file
from beltdyn.results.staged_file import find_checksums

_LONGEST_REASON = 200
"""Characters of a library's reason in a message, at most; a safeguard against long ones."""

# One writer for a file at a time

_OURS: ContextVar[frozenset[Path]] = ContextVar("_OURS", default=frozenset())
"""Locks that the caller holds, and what it calls need not take."""


class OutputLock:
    """A lock on a file (without links on the way to it), which a killed process gives back.

    It lies beside the file, ``.NAME.lock``, and is removed when given back. ModelError if another process holds it
    longer than `patience` (s).
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
    """The file that is there while a run writes a result, and after a run that was killed."""
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


MARK = "beltdyn"
"""The generator named in pictures and pages."""

_MARKED = 4096
"""Bytes at the start and at the end of a file among which the mark is sought."""

_PATIENCE = 1.0
"""How long to wait for others who write the same file, s."""

_FULL = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))


@contextmanager
def atomic_path(path: Path, is_ours: Callable[[Path], bool], overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary path that is moved to `path` on success."""
    require_replaceable(path, is_ours, overwrite)
    target = target_of(path)
    temporary = target.with_name(f".{target.stem}.{secrets.token_hex(4)}{target.suffix}")
    try:
        with locked(target, _PATIENCE):
            remove_leftovers(target)
            try:
                yield temporary
                temporary.replace(target)
            finally:
                with suppress(OSError):
                    temporary.unlink(missing_ok=True)
    except OSError as error:
        raise ModelError(unwritable(path, error)) from error


@contextmanager
def locked_output(path: Path) -> Iterator[None]:
    """Let nobody else write to a file meanwhile."""
    with ExitStack() as held:
        try:
            held.enter_context(locked(target_of(path)))
        except OSError as error:
            raise ModelError(unwritable(path, error)) from error
        yield


def target_of(path: Path) -> Path:
    """The file that a path leads to, whether or not it is there."""
    try:
        target = path.resolve()
        target.is_symlink()  # from Python 3.13 on a circle is told here at the earliest
        return target
    except (OSError, RuntimeError) as error:
        loop = OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        raise ModelError(unwritable(path, loop if isinstance(error, RuntimeError) else error)) from error


def require_replaceable(path: Path, is_ours: Callable[[Path], bool], overwrite: bool = False) -> None:
    """Check that writing a file does not destroy another one."""
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return
    except (OSError, ValueError) as error:
        raise ModelError(unwritable(path, error)) from error
    if not stat.S_ISREG(mode):
        kind = "folder" if stat.S_ISDIR(mode) else "device or a pipe"
        raise ModelError(f"{path} cannot be written (it is a {kind}, not a file). Choose another name.")
    if not overwrite and not is_ours(path):
        raise ModelError(
            f"{path} already exists and was not written by beltdyn for this purpose, or is damaged; it would be lost. "
            "Choose another name, or replace it with --force (in Python: overwrite=True)."
        )


def stamp(path: Path) -> tuple[int, int] | None:
    """Inode and time of a file, which identify it and its version."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return status.st_ino, status.st_mtime_ns


def remove_leftovers(path: Path) -> None:
    """Remove temporary files of `atomic_path` that a killed process has left beside a file."""
    pattern = re.compile(rf"\.{re.escape(path.stem)}\.[0-9a-f]{{8}}{re.escape(path.suffix)}")
    with suppress(OSError):
        for file in path.parent.iterdir():
            if pattern.fullmatch(file.name) and file.is_file():
                file.unlink(missing_ok=True)


def is_marked(path: Path, mark: str = MARK) -> bool:
    """Whether a file carries the mark of beltdyn."""
    with suppress(OSError), path.open("rb") as file:
        start = file.read(_MARKED)
        file.seek(max(path.stat().st_size - _MARKED, 0))
        return mark.encode() in start or mark.encode() in file.read()
    return False


def unwritable(path: Path, error: Exception) -> str:
    """Message for a file that cannot be written, with the remedy."""
    number = getattr(error, "errno", None)
    if number in _FULL:
        return f"{path} cannot be written ({os.strerror(number)}). Make room, or write to another disk."
    reason = os.strerror(number) if number else str(error)
    return f"{path} cannot be written ({reason}). Choose a file in an existing folder with write permission."


def make_folder(folder: Path) -> Path:
    """Create a folder and its parents unless they exist."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ModelError(f"the folder {folder} cannot be created ({error.strerror}). Choose another folder.") from error
    return folder


def unreadable(path: Path, error: Exception) -> str:
    """Message for a file that cannot be read as a result."""
    reason = " ".join(str(getattr(error, "strerror", None) or error).split())[:_LONGEST_REASON]
    said = f"{path} cannot be read as a result file: {reason or type(error).__name__}."
    if lock_file(target_of(path)).exists():
        return f"{said} A run is writing it, or was killed while doing so: try again in a moment."
    if isinstance(error, FileNotFoundError):
        return f"{path} does not exist. Give the result file of `beltdyn simulate` or another analysis."
    return (
        f"{said} Give a file written by `beltdyn simulate`; if it is such a file, it is damaged: run the drive again."
    )

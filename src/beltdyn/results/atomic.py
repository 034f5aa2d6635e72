"""Atomic writing of files that replace only files of beltdyn."""

import errno
import os
import re
import secrets
import stat
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.results.lock import locked

MARK = "beltdyn"
"""The generator named in pictures and pages."""

_MARKED = 4096
"""Bytes at the start and at the end of a file among which the mark is sought."""

_PATIENCE = 1.0
"""How long to wait for others who write the same file, s."""

_FULL = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))


@contextmanager
def atomic_path(path: Path, is_ours: Callable[[Path], bool], overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary path that is moved to `path` on success.

    Parameters
    ----------
    path : Path
        The file to be written; of a symbolic link that to which it leads.
    is_ours : callable
        Tells whether a regular file that exists was written by beltdyn, and so may be replaced.
    overwrite : bool
        Replace any regular file.

    Yields
    ------
    Path
        A path in the same folder with the same suffix.

    Raises
    ------
    ModelError
        If the file cannot be written, is being written by another one, or would replace one that is not ours.
    """
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
    """Let nobody else write to a file meanwhile.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    ModelError
        If another one writes to it, or nobody can.
    """
    with ExitStack() as held:
        try:
            held.enter_context(locked(target_of(path)))
        except OSError as error:
            raise ModelError(unwritable(path, error)) from error
        yield


def target_of(path: Path) -> Path:
    """The file that a path leads to, whether or not it is there.

    Raises
    ------
    ModelError
        If links lead in a circle.
    """
    try:
        target = path.resolve()
        target.is_symlink()  # from Python 3.13 on a circle is told here at the earliest
        return target
    except (OSError, RuntimeError) as error:
        loop = OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        raise ModelError(unwritable(path, loop if isinstance(error, RuntimeError) else error)) from error


def require_replaceable(path: Path, is_ours: Callable[[Path], bool], overwrite: bool = False) -> None:
    """Check that writing a file does not destroy another one.

    Parameters
    ----------
    path : Path
        The file.
    is_ours : callable
        Tells whether a regular file that exists was written by beltdyn.
    overwrite : bool
        Whether any regular file may be replaced.

    Raises
    ------
    ModelError
        If the path is a file of another program, or not a file.
    """
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
    """Inode and time of a file, which identify it and its version.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    number, time : int, or None
        None where there is no file.
    """
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return status.st_ino, status.st_mtime_ns


def remove_leftovers(path: Path) -> None:
    """Remove temporary files of `atomic_path` that a killed process has left beside a file.

    Parameters
    ----------
    path : Path
        The file that was to be written, which the caller has locked.
    """
    pattern = re.compile(rf"\.{re.escape(path.stem)}\.[0-9a-f]{{8}}{re.escape(path.suffix)}")
    with suppress(OSError):
        for file in path.parent.iterdir():
            if pattern.fullmatch(file.name) and file.is_file():
                file.unlink(missing_ok=True)


def is_marked(path: Path, mark: str = MARK) -> bool:
    """Whether a file carries the mark of beltdyn.

    Parameters
    ----------
    path : Path
        A regular file.
    mark : str
        What it holds near its start or its end.

    Returns
    -------
    bool
        False too if it cannot be read.
    """
    with suppress(OSError), path.open("rb") as file:
        start = file.read(_MARKED)
        file.seek(max(path.stat().st_size - _MARKED, 0))
        return mark.encode() in start or mark.encode() in file.read()
    return False


def unwritable(path: Path, error: Exception) -> str:
    """Message for a file that cannot be written, with the remedy.

    Parameters
    ----------
    path : Path
        The file.
    error : Exception
        The error of the operating system.

    Returns
    -------
    str
        The message.
    """
    number = getattr(error, "errno", None)
    if number in _FULL:
        return f"{path} cannot be written ({os.strerror(number)}). Make room, or write to another disk."
    reason = os.strerror(number) if number else str(error)
    return f"{path} cannot be written ({reason}). Choose a file in an existing folder with write permission."


def make_folder(folder: Path) -> Path:
    """Create a folder and its parents unless they exist.

    Parameters
    ----------
    folder : Path
        The folder.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    ModelError
        If it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ModelError(f"the folder {folder} cannot be created ({error.strerror}). Choose another folder.") from error
    return folder

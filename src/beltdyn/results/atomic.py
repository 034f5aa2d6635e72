"""Files that are either complete or not there."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from beltdyn.errors import ModelError


@contextmanager
def atomic_path(path: Path) -> Iterator[Path]:
    """Give a temporary path, and move what was written there to `path` when all went well.

    Parameters
    ----------
    path : Path
        The file to be written; one that exists is replaced.

    Yields
    ------
    Path
        A path in the same folder with the same suffix.

    Raises
    ------
    ModelError
        If the file cannot be written.
    """
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}{path.suffix}")
    try:
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise ModelError(unwritable(path, error)) from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def unwritable(path: Path, error: OSError) -> str:
    """Say why a file cannot be written and what to do about it.

    Parameters
    ----------
    path : Path
        The file.
    error : OSError
        What the operating system answered.

    Returns
    -------
    str
        The message.
    """
    reason = os.strerror(error.errno) if error.errno else str(error)
    return f"{path} cannot be written ({reason}). Choose a file in a folder that exists and may be written to."


def make_folder(folder: Path) -> Path:
    """Make a folder and its parents unless they exist.

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
        raise ModelError(f"the folder {folder} cannot be made ({error.strerror}). Choose another one.") from error
    return folder

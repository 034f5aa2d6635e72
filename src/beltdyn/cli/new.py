"""`beltdyn new`."""

from importlib.resources import files
from pathlib import Path

from beltdyn.cli.console import show
from beltdyn.errors import ModelError


def new(file: Path = Path("drive.toml"), /) -> None:
    """Write a commented drive file to start from.

    Parameters
    ----------
    file
        The drive file to write; it must not exist yet.
    """
    if file.exists():
        raise ModelError(f"{file} exists already, and would be overwritten. Choose another name, or remove it.")
    write_text(file, files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8"))
    show(f"{file} is written. Edit it, then: beltdyn check {file}; beltdyn run {file}")


def write_text(file: Path, text: str) -> None:
    """Write a text file, and the folders it is in.

    Raises
    ------
    ModelError
        If it cannot be written.
    """
    try:
        if not file.parent.exists():
            file.parent.mkdir(parents=True)
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ModelError(f"{file} cannot be written: {reason}. Choose a folder that can be written to.") from error

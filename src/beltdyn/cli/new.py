"""`beltdyn new`."""

from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.errors import ModelError


def new(
    file: Path | None = None, /, *, example: Annotated[str | None, Parameter(alias="-e", show_default=False)] = None
) -> None:
    """Write a commented drive file to start from.

    Parameters
    ----------
    file
        The drive file to write, by default drive.toml, or the example's name with .toml; it must not exist yet.
    example
        Write an example in place of the plain two-pulley drive: accessory_drive, alternator_drive, band_brake,
        conveyor, crossed_belt, fan_direct_start, flat_belt_idler, slip_through, tensioner_stop, two_pulley,
        unequal_radii or washing_machine.
    """
    source = files("beltdyn.cli").joinpath("new_drive.toml") if example is None else _example(example)
    target = file or Path("drive.toml" if example is None else source.name)
    refuse_existing(target)
    write_text(target, source.read_text(encoding="utf-8"))
    show(f"{target} is written. Edit it, then: beltdyn check {target}; beltdyn run {target}")


def _example(name: str) -> Traversable:
    """The drive file of an example, by its name with - or _."""
    suffix = ".toml"
    found = {file.name.removesuffix(suffix): file for file in files("beltdyn").joinpath("examples").iterdir()}
    key = name.removesuffix(suffix).replace("-", "_")
    if key not in found:
        raise ModelError(f"example {name!r} is not known. Choose out of {', '.join(sorted(found))}.")
    return found[key]


def refuse_existing(file: Path) -> None:
    """Make sure that a file is not there yet.

    Raises
    ------
    ModelError
        If it is.
    """
    if file.exists():
        raise ModelError(f"{file} exists already, and would be overwritten. Choose another name, or remove it.")


def write_text(file: Path, text: str) -> None:
    """Write a text file, and the folders it is in.

    Raises
    ------
    ModelError
        If it cannot be written.
    """
    from beltdyn.results.atomic import atomic_path, make_folder

    make_folder(file.parent)
    with atomic_path(file, lambda _: False) as temporary:
        temporary.write_text(text, encoding="utf-8")

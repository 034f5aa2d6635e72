"""`beltdyn new`, `beltdyn keys` and `beltdyn schema`: drive files to begin with, and what may stand in them."""

import json
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_facts, show_grid
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.show.key_tables import Key


def new(
    file: Path | None = None, /, *, example: Annotated[str | None, Parameter(alias="-e", show_default=False)] = None
) -> None:
    """Write a commented drive file to start from.

    Parameters
    ----------
    file
        The drive file to write, by default drive.toml or EXAMPLE.toml; it must not exist.
    example
        Write an example instead of the plain two-pulley drive: accessory_drive, alternator_drive, band_brake,
        conveyor, conveyor_1km, crossed_belt, fan_direct_start, flat_belt_idler, gantry_axis, package_conveyor,
        printer_axis, servo_axis, slip_through, tensioner_stop, timing_drive, two_pulley, unequal_radii or
        washing_machine.
    """
    if example is None:
        from beltdyn.model.toml import example_texts

        if file is not None and file.name in example_texts():
            raise ModelError(f"{file} is the name of an example. Type `beltdyn new -e {file}` for it, or {file}.toml.")
        name, text = "drive", files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8")
    else:
        from beltdyn.model.toml import example_text

        name, text = example.removesuffix(".toml").replace("-", "_"), example_text(example)
    target = file or Path(f"{name}.toml")
    refuse_existing(target)
    write_text(target, text)
    show(f"Written: {target}   (edit it, then: beltdyn check {target}; beltdyn simulate {target})")


def refuse_existing(file: Path) -> None:
    """Raise ModelError if a file exists."""
    if file.exists():
        raise ModelError(f"{file} already exists and would be overwritten. Choose another name, or remove it.")


def write_text(file: Path, text: str) -> None:
    """Write a text file and its folders."""
    from beltdyn.results.atomic import atomic_path, make_folder

    make_folder(file.parent)
    with atomic_path(file, lambda _: False) as temporary:
        temporary.write_text(text, encoding="utf-8")


# `beltdyn keys` and `beltdyn schema`


def keys(group: str | None = None, /) -> None:
    """Print the keys of drive and study files, with units, defaults and meanings.

    Parameters
    ----------
    group
        A group such as belt, a kind such as load.motor, or a key such as friction; by default the groups are listed.
    """
    from beltdyn.show.key_tables import groups_for, key_groups

    if group is None:
        show_facts((name, each.heading) for name, each in key_groups().items())
        show("\n`beltdyn keys belt` prints the keys of a group, `beltdyn keys friction` the groups that have a key.")
        return
    for name, each in groups_for(group).items():
        show(f"{each.heading}   ({name})" if each.keys else f"{each.heading} has no keys.")
        show_grid(("key", "unit", "default", "meaning"), (_row(key) for key in each.keys))
        show()


def _row(key: "Key") -> tuple[str, ...]:
    """A key in a table of the terminal, where the unit has a column of its own."""
    meaning = key.meaning.replace(f", in {key.unit}", "", 1) if key.unit else key.meaning
    return key.name, key.unit, key.default.strip("`"), meaning.replace("`", "")


def schema() -> None:
    """Print the JSON schema of drive files, for checks and completion in editors."""
    from beltdyn.model import json_schema

    show(json.dumps(json_schema(), indent=2, ensure_ascii=False))

"""`beltdyn fmu`."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.cli.progress import progress_bar


def fmu(
    file: Path,
    /,
    *,
    to: Annotated[Path | None, Parameter(name="-o")] = None,
    inputs: Annotated[list[str] | None, Parameter(name="--input", negative="")] = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    fmi: Literal["2.0", "3.0"] = "2.0",
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Write a drive as a functional mock-up unit (FMU) for co-simulation with models of other programs.

    It needs `pip install "beltdyn[fmu]"`, and the program that simulates it a Python with beltdyn.

    Parameters
    ----------
    file
        The drive file, TOML.
    to
        The FMU; by default FILE.fmu, beside the drive file.
    inputs
        What other programs set, once for each: pulley[NAME].speed of a pulley whose speed is prescribed,
        pulley[NAME].torque of another one; by default all that the drive file gives.
    outputs
        What they read, once for each: a result such as pulley_speed[NAME], or pulley_speed for that of all pulleys; by
        default all.
    fmi
        The version of FMI.
    force
        Replace other files than those of beltdyn too.
    """
    from beltdyn.cosimulation import fmu as write
    from beltdyn.model import load

    path = file.with_suffix(".fmu") if to is None else to
    drive = load(file)
    with progress_bar() as report:
        write(drive, path, inputs, outputs, fmi=fmi, progress=report, overwrite=force)
    show(f"Written: {path}   (FMI {fmi}, co-simulation)")

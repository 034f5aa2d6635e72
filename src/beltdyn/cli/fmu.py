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

    Writing needs the extra beltdyn[fmu]; the simulating program needs a Python with beltdyn.

    Parameters
    ----------
    file
        The drive file, TOML.
    to
        The FMU; by default FILE.fmu, beside the drive file.
    inputs
        An input of the FMU, repeatable: pulley[NAME].speed of a pulley with prescribed speed, pulley[NAME].torque of
        any other; by default all that the drive file prescribes.
    outputs
        An output of the FMU, repeatable: a result such as pulley_speed[NAME], or pulley_speed for all pulleys; by
        default all.
    fmi
        The FMI version.
    force
        Also replace files that beltdyn did not write.
    """
    from beltdyn.cosimulation import fmu as write
    from beltdyn.model import load

    path = file.with_suffix(".fmu") if to is None else to
    drive = load(file)
    with progress_bar() as report:
        write(drive, path, inputs, outputs, fmi=fmi, progress=report, overwrite=force)
    show(f"Written: {path}   (FMI {fmi}, co-simulation)")

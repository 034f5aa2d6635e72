"""Commands that serve other programs: kernels compiled in advance, the page for the browser, co-simulation units."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter
from cyclopts.validators import Number

from beltdyn.cli.console import show as write
from beltdyn.cli.progress import compilation_bar, progress_bar

_USUAL = ("alternator_drive",)
"""Examples that need the kernels of most drives."""
_SHORT = 0.01
"""Time of a run that compiles what all runs need, s."""


def compile_(*files: Path) -> None:
    """Compile kernels in advance, once on this machine, so that later commands start at once.

    Parameters
    ----------
    files
        Drive files, such as those with laws of your own; by default the kernels of usual drives are compiled.
    """
    from beltdyn.kernel import kernel_cache
    from beltdyn.model import example, load
    from beltdyn.state.installation import bring_to_rest
    from beltdyn.transient.simulate import simulate
    from beltdyn.vibration.modes import modes

    drives = [load(file) for file in files] or [example(name) for name in _USUAL]
    with compilation_bar():
        for drive in drives:
            outputs = {"output_interval": None, "field_interval": None, "start_at": None}
            short = drive.replace(simulation=drive.simulation.replace(duration=_SHORT, **outputs))
            simulate(short)
            bring_to_rest(drive)
            modes(drive)
    write(f"Kernels are compiled: {kernel_cache()}")


def app(
    file: Path | None = None,
    /,
    *,
    port: Annotated[int, Parameter(validator=Number(gte=0, lte=65535))] = 0,
    show: bool = True,
) -> None:
    """Edit and simulate a drive in the browser.

    The page is served on this machine only, at a secret address, and needs no network. It reads and writes drive files
    only in the folder of the given file, by default the working directory. Ctrl-C ends it.

    Parameters
    ----------
    file
        The drive file to open, TOML.
    port
        The port; by default any free one.
    show
        Open the browser; --no-show only prints the address.
    """
    from beltdyn.errors import ModelError

    try:
        from beltdyn.app.server import serve
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("beltdyn"):
            raise
        raise ModelError(
            f"the page needs {error.name}, which is not installed. Install beltdyn with its extra beltdyn[app]."
        ) from None
    from beltdyn.app.computing import Asked, Calculator
    from beltdyn.app.workspace import Folder, Workspace

    folder = Folder(Path() if file is None else file.parent)
    if file is not None:
        folder.read(file.name)  # an unreadable file is reported here
    calculator = Calculator()
    workspace = Workspace(folder, None if file is None else file.name, calculator)

    def begin(address: str) -> None:
        write(f"The page is at {address}\nCtrl-C ends it.")
        calculator.look_ahead(Asked("rest", "", workspace.usual_drive, folder.root))

    serve(workspace, port, show, begin)


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
    from beltdyn.cosimulation import fmu as write_unit
    from beltdyn.model import load

    path = file.with_suffix(".fmu") if to is None else to
    drive = load(file)
    with progress_bar() as report:
        write_unit(drive, path, inputs, outputs, fmi=fmi, progress=report, overwrite=force)
    write(f"Written: {path}   (FMI {fmi}, co-simulation)")

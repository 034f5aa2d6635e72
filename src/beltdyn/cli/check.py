"""`beltdyn check`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_warnings
from beltdyn.cli.progress import progress_bar
from beltdyn.cli.result import show_parts


def check(
    file: Path,
    /,
    *,
    figure: Annotated[Path | None, Parameter(alias="-f")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Validate a drive file, and say what to expect of the drive at rest.

    Parameters
    ----------
    file
        The drive file, TOML.
    figure
        Draw the layout into this file too, such as layout.png; it replaces figures of beltdyn, and no other files.
    force
        Replace other files too.
    """
    from beltdyn.errors import ConvergenceError
    from beltdyn.model import advise, install, load, unstable_balance
    from beltdyn.results.rest_sheet import rest_sheet
    from beltdyn.solve import bring_to_rest

    drive = given = load(file)
    if figure is not None:
        from beltdyn.results.atomic import is_marked, require_replaceable

        require_replaceable(figure, is_marked, force)
    estimate = install(drive)
    failure: ConvergenceError | None = None
    unstable: tuple[str, ...] = ()
    try:
        with progress_bar() as report:
            rest = bring_to_rest(drive, report)
        drive, installation, unstable = rest.drive, rest.installation, rest.unstable
    except ConvergenceError as error:
        failure, installation = error, estimate
        show("No static equilibrium was found. These are estimates by hand, without bending and weight.\n")
    show_parts(rest_sheet(given, drive, installation).parts)
    show()
    show_warnings([*([str(unstable_balance(unstable))] if unstable else []), *advise(given, estimate)])
    if figure is None:
        show(f"To see the layout: beltdyn check {file} --figure layout.png")
    else:
        from beltdyn import plot

        show(f"Layout: {plot.save_layout(drive, figure, installation, force)}")
    if failure:
        raise failure

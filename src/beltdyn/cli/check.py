"""`beltdyn check`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beltdyn.cli.console import lines_of_file, show, show_error, show_warnings
from beltdyn.cli.output import show_parts
from beltdyn.cli.progress import progress_bar
from beltdyn.errors import BeltdynError, ModelError


def check(
    file: Path,
    /,
    *more: Path,
    figure: Annotated[Path | None, Parameter(alias="-f")] = None,
    equilibrium: bool | None = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Validate drive files, and show each drive at rest.

    The answer says whether it is the computed equilibrium or that of closed forms, which need no compilation. All files
    are checked, even if some are invalid; the exit code is 2 if any file is invalid.

    Parameters
    ----------
    file
        The drive file, TOML.
    more
        More drive files.
    figure
        Also plot the layout of a single drive to this file, such as layout.png. Only figures that beltdyn wrote are
        replaced.
    equilibrium
        Whether to compute the static equilibrium. By default it is computed where its kernels are compiled.
    force
        Also replace files that beltdyn did not write.
    """
    if not more:
        _check(file, figure, equilibrium, force)
        return 0
    if figure is not None:
        raise ModelError(
            f"--figure {figure} plots one drive, but {1 + len(more)} files are given. Check them separately."
        )
    codes = []
    for number, one in enumerate((file, *more)):
        show("\n" * (number > 0) + str(one))
        try:
            _check(one, None, equilibrium, force)
        except BeltdynError as error:
            show_error("\n".join(lines_of_file(one, error)))
            codes.append(error.exit_code)
    return min(codes, default=0)


def _check(file: Path, figure: Path | None, equilibrium: bool | None, force: bool) -> None:
    """Check one drive file."""
    from beltdyn.model import load
    from beltdyn.show.rest_sheet import check as check_drive

    drive = load(file)
    if figure is not None:
        from beltdyn.results.atomic import is_marked, require_replaceable

        require_replaceable(figure, is_marked, force)
    with progress_bar() as report:
        checked = check_drive(drive, report, equilibrium=equilibrium)
    if checked.failure:
        show("No static equilibrium was found. These are closed forms.\n")
    show_parts(checked.sheet.parts)
    show()
    show_warnings(checked.warnings)
    if not (checked.computed or checked.failure):
        show(f"Compute the static equilibrium: beltdyn check {file} --equilibrium")
    if figure is None:
        show(f"Plot the layout: beltdyn check {file} --figure layout.png")
    else:
        from beltdyn.show import plot

        show(f"Layout: {plot.save_layout(checked.drive, figure, checked.installation, force)}")
    if checked.failure:
        raise checked.failure

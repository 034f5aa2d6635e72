"""`beltdyn static`."""

from pathlib import Path

from beltdyn.cli.check import other_balances
from beltdyn.cli.console import show
from beltdyn.cli.progress import progress_bar
from beltdyn.cli.summary import show_summary


def static(file: Path, /) -> None:
    """Find the static equilibrium of a drive at rest: tensions, wrap angles and hub loads.

    Parameters
    ----------
    file
        The drive file, TOML.
    """
    from beltdyn.model import install, load
    from beltdyn.solve import equilibrium

    drive = load(file)
    with progress_bar() as report:
        run = equilibrium(drive, report)
    show("Static equilibrium")
    show_summary(run)
    names = [one.pulley for one in drive.moving_tensioners]
    for name, others in zip(names, other_balances(run.drive, install(run.drive)), strict=True):
        if others:
            show(f"The tensioner of {name} balances the belt at {others} too.")

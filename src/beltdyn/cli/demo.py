"""`beltdyn demo`."""

from pathlib import Path

from beltdyn.analyses import ANALYSES, RUN
from beltdyn.cli.console import show
from beltdyn.cli.new import refuse_existing, write_text
from beltdyn.cli.output import analyse_to, ended
from beltdyn.cli.plot import draw


def demo(folder: Path = Path("beltdyn-demo"), /) -> int:
    """Run the two-pulley drive of Kerkkänen, García-Vallejo and Mikkola (2006), and draw its figures.

    Parameters
    ----------
    folder
        The folder for the drive file, its results and its figures.
    """
    from beltdyn.model import load
    from beltdyn.published import demo_text

    file = folder / "two_pulley.toml"
    if not (file.is_file() and file.read_text("utf-8", "replace") == demo_text()):
        refuse_existing(file)
        write_text(file, demo_text())
    show(f"Drive file: {file}   (look at it with: beltdyn check {file})")
    run = analyse_to(ANALYSES[RUN], load(file), folder / "two_pulley.nc")
    if run.status == "completed":
        draw([run], folder)
    return ended(run)

"""`beltdyn demo`."""

from pathlib import Path

from beltdyn.analyses import ANALYSES, RUN
from beltdyn.cli.console import show
from beltdyn.cli.new import refuse_existing, write_text
from beltdyn.cli.output import analyse_to, ended
from beltdyn.cli.plot import draw

_DRIVE = "fan_direct_start"


def demo(folder: Path = Path("beltdyn-demo"), /) -> int:
    """Simulate the start of a 15 kW fan by an induction motor and three V-belts, and plot the figures.

    Parameters
    ----------
    folder
        The folder for the drive file, its results and its figures.
    """
    from beltdyn.model import load
    from beltdyn.model.examples import example_text

    file, text = folder / f"{_DRIVE}.toml", example_text(_DRIVE)
    if not (file.is_file() and file.read_text("utf-8", "replace") == text):
        refuse_existing(file)
        write_text(file, text)
    show(f"Drive file: {file}   (summary: beltdyn check {file})")
    run = analyse_to(ANALYSES[RUN], load(file), folder / f"{_DRIVE}.nc")
    if run.status == "completed":
        draw([run], folder)
    return ended(run)

"""The study of docs/examples/accessory_drive.md: its numbers and its picture."""

import sys
import time
from functools import cache
from importlib.resources import files
from pathlib import Path

import beltdyn as bd
from beltdyn.cli.output import show_result

PAGES = Path(__file__).parents[1]
LENGTH = 1.514
"""Of the belt as it is bought, m."""


def given() -> bd.Drive:
    """The accessory drive with a belt of a given length, which the spring of the tensioner tensions."""
    drive = bd.load(str(files("beltdyn").joinpath("examples", "accessory_drive.toml")))
    return drive.with_({"belt.length": LENGTH})


@cache
def found() -> bd.Result:
    """The result of the study, which is made once."""
    return bd.optimize(given(), study=PAGES / "examples" / "tensioner_study.toml")


def main() -> None:
    """Run the study and draw its picture."""
    begun = time.process_time()
    result = found()
    show_result(result)
    sys.stdout.write(f"{time.process_time() - begun:.1f} s of one core\n")
    for design, goal in enumerate(result.dataset["design_goal"].values, 1):
        sys.stdout.write(f"design {design}: {goal:.1f} N\n")
    pictures = PAGES / "_static" / "examples"
    bd.plot.save_all(result, pictures, ("optimization",))
    (pictures / "optimization.png").replace(pictures / "tensioner_study.png")


if __name__ == "__main__":
    main()

"""Run the examples, draw the pictures of their pages, and print the numbers: `python docs/make_examples.py [NAME...]`.

Without a name all are run, one after another, in about two minutes.  Pictures go to docs/_static/examples, results into
a folder that is removed at the end.
"""

import argparse
import shutil
import sys
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType

from example_numbers import NUMBERS
from PIL import Image

import beltdyn as bd
from beltdyn.cli.summary import show_summary

PICTURES = Path(__file__).parent / "_static" / "examples"
FIGURES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "two_pulley": ("speeds", "span_tensions", "contact_forces"),
        "unequal_radii": ("speeds", "torques", "slip", "capstan_margins"),
        "crossed_belt": ("configuration", "speeds", "slip"),
        "washing_machine": ("speeds", "span_tensions", "capstan_margins"),
        "flat_belt_idler": ("span_tensions", "contact_pressure", "capstan_margins", "tensioners"),
        "slip_through": ("speeds", "torques", "capstan_margins", "slip"),
    }
)
"""What each page shows beside the layout, which stands for it in the gallery."""

COLORS = 64
"""Colors of a picture, which keep it small."""


def make(name: str, folder: Path) -> None:
    """Run an example, draw its pictures and print its numbers.

    Parameters
    ----------
    name
        The example.
    folder
        Where pictures are drawn first.
    """
    drive = bd.load(str(files("beltdyn").joinpath("examples", f"{name}.toml")))
    bd.plot.save_layout(drive, folder / "layout.png")
    run = bd.simulate(drive)
    bd.plot.save_all(run, folder, FIGURES[name])
    for figure in ("layout", *FIGURES[name]):
        with Image.open(folder / f"{figure}.png") as picture:
            small = picture.convert("RGB").quantize(COLORS)
        small.save(PICTURES / f"{name}_{figure}.png", optimize=True)
    show_summary(run)
    rows = [(number.what, f"{number.hand:.5g}", f"{number.found:.5g}") for number in NUMBERS[name](run)]
    lines = [" | ".join(row) for row in (("", "by hand", "run"), ("---", "---", "---"), *rows)]
    sys.stdout.write("".join(f"| {line} |\n" for line in lines))


def main(arguments: Sequence[str] | None = None) -> None:
    """Make the examples that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="examples, by default all")
    names = parser.parse_args(arguments).names or list(FIGURES)
    PICTURES.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as scratch:
        for name in names:
            sys.stdout.write(f"\n{name}\n")
            sys.stdout.flush()
            folder = Path(scratch) / name
            folder.mkdir()
            make(name, folder)
            shutil.rmtree(folder)


if __name__ == "__main__":
    main()

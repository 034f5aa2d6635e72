"""Run the examples, draw their pictures, and print their numbers: `python docs/scripts/make_examples.py [NAME...]`.

Without a name all are run, one after another, in about four minutes.  Pictures go to docs/_static/examples.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import NamedTuple

import example_axes as axes
import example_conveyors as carrying
import example_numbers as by_hand
import example_teeth as toothed
import example_tensioners as tensioned
import examples_accessory_drive as accessory
from PIL import Image

import beltdyn as bd
from beltdyn.cli.output import show_result

PICTURES = Path(__file__).parents[1] / "_static" / "examples"


class Example(NamedTuple):
    """What a page shows.

    Attributes
    ----------
    figures : tuple of str
        Those of the run beside the layout, which stands for the example in the gallery.
    numbers : callable
        What the page's table says, from the run.
    study : callable, optional
        What is run besides: given the run and a folder for figures, it yields lines of numbers.
    """

    figures: tuple[str, ...]
    numbers: Callable[[bd.Run], Iterator[by_hand.Number]]
    study: Callable[[bd.Run, Path], Iterator[str]] = lambda run, folder: iter(())


EXAMPLES: Mapping[str, Example] = MappingProxyType(
    {
        "two_pulley": Example(("speeds", "span_tensions", "contact_forces"), by_hand.two_pulley),
        "unequal_radii": Example(("speeds", "torques", "slip", "slip_safety"), by_hand.unequal_radii),
        "fan_direct_start": Example(("speeds", "torques", "span_tensions", "slip_safety"), by_hand.fan_direct_start),
        "crossed_belt": Example(("configuration", "speeds", "slip"), by_hand.crossed_belt_drive),
        "washing_machine": Example(
            ("speeds", "span_tensions", "slip_safety"), by_hand.washing_machine, by_hand.slip_on_a_small_pulley
        ),
        "flat_belt_idler": Example(
            ("span_tensions", "contact_pressure", "slip_safety", "tensioners"),
            by_hand.flat_belt_idler,
            by_hand.worth_of_the_idler,
        ),
        "band_brake": Example(("span_tensions", "configuration", "slip_safety"), by_hand.band_brake),
        "conveyor": Example(("configuration", "span_tensions", "tensioners"), tensioned.conveyor),
        "alternator_drive": Example(("speeds", "span_tensions", "tensioners", "hub_loads"), tensioned.alternator_drive),
        "tensioner_stop": Example(("span_tensions", "tensioners", "slip_safety"), tensioned.tensioner_stop),
        "timing_drive": Example(("span_tensions", "contact_pressure"), toothed.timing_drive),
        "printer_axis": Example(("carriage_error", "span_tensions"), axes.printer_axis),
        "gantry_axis": Example(("carriage_error",), axes.gantry_axis),
        "servo_axis": Example(("speeds", "span_tensions"), toothed.servo_axis),
        "conveyor_1km": Example(("torques", "span_tensions", "tensioners"), carrying.conveyor_1km),
        "package_conveyor": Example(("speeds", "span_tensions"), carrying.package_conveyor),
        "slip_through": Example(("speeds", "torques", "slip_safety", "slip"), by_hand.slip_through),
        "accessory_drive": Example(
            ("speeds", "span_tensions", "tensioners", "slip", "hub_loads"), accessory.numbers, accessory.study
        ),
    }
)

COLORS = 256
"""Colors of a picture, which keep it small; Pillow's maximum coverage keeps those of thin lines."""


@cache
def simulated(name: str) -> bd.Run:
    """Give the run of an example, which is made once."""
    return bd.simulate(bd.load(str(files("beltdyn").joinpath("examples", f"{name}.toml"))))


def make(name: str, folder: Path) -> None:
    """Run an example, draw its pictures and print its numbers.

    Parameters
    ----------
    name
        The example.
    folder
        Where pictures are drawn first.
    """
    example, run = EXAMPLES[name], simulated(name)
    bd.plot.save_layout(run.drive, folder / "layout.png")
    bd.plot.save_all(run, folder, example.figures)
    show_result(run)
    rows = [
        (number.what, f"{number.hand:.5g}", f"{number.found:.5g}", f"{number.found / number.hand - 1.0:+.2%}")
        for number in example.numbers(run)
    ]
    lines = [" | ".join(row) for row in (("", "by hand", "run", "difference"), ("---",) * 4, *rows)]
    sys.stdout.write("".join(f"| {line} |\n" for line in lines))
    for line in example.study(run, folder):
        sys.stdout.write(f"{line}\n")
    for drawn in folder.glob("*.png"):
        with Image.open(drawn) as picture:
            small = picture.convert("RGB").quantize(COLORS, Image.Quantize.MAXCOVERAGE, kmeans=1)
        small.save(PICTURES / f"{name}_{drawn.name}", optimize=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Make the examples that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="examples, by default all")
    names = parser.parse_args(arguments).names or list(EXAMPLES)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names:
        sys.stdout.write(f"\n{name}\n")
        sys.stdout.flush()
        with TemporaryDirectory() as folder:
            make(name, Path(folder))


if __name__ == "__main__":
    main()

"""Steady running from rest and from a neighbor, a map of 40 points, and the run over time that gives the same.

Processor time of one thread, medians; compilation is apart: each analysis is done once before the clock starts.
"""

import statistics
import time
from collections.abc import Callable
from functools import partial
from importlib.resources import files

from rich.console import Console
from rich.table import Table

from beltdyn import load, operating_map, simulate, steady_state
from beltdyn.model import Drive
from beltdyn.points.changed_drive import held_at, with_load
from validation.published.cases import better, loaded_two_pulley

ROUNDS = 5
POINTS = 40
_LIGHTER = 0.98
"""Loads of the drive over those of its neighbor."""


def accessory_drive() -> Drive:
    """The seven pulleys of the example."""
    return load(str(files("beltdyn") / "examples" / "accessory_drive.toml"))


def timing_drive() -> Drive:
    """The toothed belt with four pulleys of the example."""
    return load(str(files("beltdyn") / "examples" / "timing_drive.toml"))


def over_time(drive: Drive) -> Drive:
    """The accessory drive until it runs steadily: no harmonics, and no dry friction that holds its arm anywhere."""
    crank, *others, compressor = drive.pulleys
    smooth = compressor.replace(load=[one.replace(harmonics=()) for one in compressor.load])
    arm = drive.tensioners[0].replace(tensioning_friction=0.0, yielding_friction=0.0, damping=2.0)
    return drive.replace(
        pulley=[crank.replace(harmonics=()), *others, smooth],
        tensioner=[arm],
        simulation=drive.simulation.replace(duration=4.0, rtol=1e-3),
    )


def seconds(analysis: Callable[[], object], rounds: int = ROUNDS) -> float:
    """Median processor time of an analysis, s."""
    taken = []
    for _ in range(rounds):
        begun = time.process_time()
        analysis()
        taken.append(time.process_time() - begun)
    return statistics.median(taken)


def main() -> None:
    """Print the table, and the map below it."""
    table = Table(
        "drive",
        "elements",
        "iterations",
        "from rest ms",
        "neighbor ms",
        "over time s",
        "ratio",
        title="Steady running",
    )
    case_2 = better(loaded_two_pulley(1e5), 60, duration=1.5, rtol=1e-4)
    accessory, timing = accessory_drive(), timing_drive()
    drives = (
        ("case 2", case_2, case_2),
        ("accessory drive", accessory, over_time(accessory)),
        ("timing drive", timing, timing),
    )
    for name, drive, timed in drives:
        found = steady_state(drive)
        rest = seconds(partial(steady_state, drive))
        held = held_at(found.drive, None)
        near, lighter = steady_state(held), with_load(held, _LIGHTER)
        neighbour = seconds(partial(steady_state, lighter, start=near))
        run = float(simulate(timed).dataset.attrs["cpu_time"])
        sizes = str(found.dataset.sizes["node"]), str(found.dataset.attrs["newton_iterations_of_search"])
        times = f"{1e3 * rest:.0f}", f"{1e3 * neighbour:.0f}", f"{run:.1f}", f"{run / rest:.0f}"
        table.add_row(name, *sizes, *times)
    Console().print(table)
    begun = time.process_time()
    operating_map(accessory, pulley="crank", speed="700..6000 rpm", points=POINTS)
    taken = time.process_time() - begun
    Console().print(
        f"Map of the accessory drive, {POINTS} points: {taken:.1f} s, {1e3 * taken / POINTS:.0f} ms a point"
    )


if __name__ == "__main__":
    main()

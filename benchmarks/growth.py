"""How time and memory grow: with elements, with pulleys, and with simulated time.

    python benchmarks/growth.py [--minutes M]

Newton iterations on drives at rest, one thread; then simulated minutes of the paper's drive into a file.
"""

import argparse
import statistics
import tempfile
from pathlib import Path
from resource import RUSAGE_SELF, getrusage

import numpy as np
from newton_iteration import time_iterations
from rich.console import Console
from rich.table import Table

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.solvers.run_progress import Progress
from validation.published import better, two_pulley

ELEMENTS = (20, 50, 100, 200, 500, 1000)
PULLEYS = (2, 4, 6, 10, 15, 20)
BELT = 400
"""Elements of the belts on many pulleys."""
RADIUS = 1.0
"""Of the circle that the pulleys stand on, m."""


def polygon(pulleys: int) -> Drive:
    """A driver and free pulleys on a circle, with the belt of the paper."""
    drive = better(two_pulley(BELT))
    angles = 2 * np.pi * np.arange(pulleys) / pulleys
    size = 0.15 * RADIUS
    places = [{"center": (RADIUS * np.cos(a), RADIUS * np.sin(a)), "radius": size} for a in angles]
    driver, driven = drive.pulleys
    free = [driven.replace(name=f"free {number}", **place) for number, place in enumerate(places[1:])]
    made = [driver.replace(**places[0]), *free]
    path = 2 * np.pi * size + 2 * RADIUS * pulleys * np.sin(np.pi / pulleys)
    return drive.replace(pulley=made, belt=drive.belt.replace(length=0.997 * path))


def growth(sizes: tuple[int, ...], costs: list[float]) -> float:
    """Exponent p of cost ~ size^p."""
    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])


def grow(console: Console, what: str, drives: dict[int, Drive]) -> None:
    """Print the time of an iteration over a size, and its growth."""
    table = Table(what, "µs per iteration", "spread")
    medians = []
    for size, drive in drives.items():
        rounds = time_iterations(drive)
        medians.append(statistics.median(rounds))
        table.add_row(f"{size}", f"{medians[-1]:.1f}", f"{min(rounds):.1f} to {max(rounds):.1f}")
    console.print(table)
    console.print(f"cost of an iteration ~ {what}^{growth(tuple(drives), medians):.3f}\n", highlight=False)


def endure(console: Console, minutes: float) -> None:
    """Simulate minutes, and print the largest memory of this process after each tenth of them."""
    drive = better(two_pulley(20))
    duration = 60.0 * minutes
    drive = drive.replace(simulation=drive.simulation.replace(duration=duration, output_interval=0.01))
    memory: dict[int, float] = {}

    def note(progress: Progress) -> None:
        memory[int(10 * progress.time / duration)] = getrusage(RUSAGE_SELF).ru_maxrss / 1024

    with tempfile.TemporaryDirectory() as folder:
        run = simulate(drive, Path(folder) / "run.nc", note)
        size = (Path(folder) / "run.nc").stat().st_size / 2**20
        pace = float(run.dataset.attrs["wall_time"]) / duration
        run.dataset.close()
    table = Table("simulated, min", "largest memory so far, MiB")
    for tenth, value in sorted(memory.items()):
        table.add_row(f"{tenth * minutes / 10:g}", f"{value:.0f}")
    console.print(table)
    console.print(f"file {size:.0f} MiB, {pace:.3f} s for each simulated second", highlight=False)


def main() -> None:
    """Print everything."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="simulated minutes (default: 10)")
    minutes = parser.parse_args().minutes
    console = Console()
    grow(console, "elements", {n: better(two_pulley(n)) for n in ELEMENTS})
    grow(console, "pulleys", {n: polygon(n) for n in PULLEYS})
    endure(console, minutes)


if __name__ == "__main__":
    main()

"""Steady running against the run over time that gives the same: seconds of computing, one thread, and their ratio.

Compilation is apart: each drive is computed once before the clock starts.  Medians are printed.
"""

import statistics
import time
from collections.abc import Callable
from importlib.resources import files

from rich.console import Console
from rich.table import Table

from beltdyn import load, simulate, steady_state
from beltdyn.model import Drive
from beltdyn.published.cases import better, loaded_two_pulley

ROUNDS = 3


def drives() -> dict[str, tuple[Drive, Drive]]:
    """By a name a drive, and the same for a run over time of which the end agrees in tensions to a few 1e-4."""
    case_2 = better(loaded_two_pulley(1e5), 60, duration=1.5, rtol=1e-4)
    accessory = load(str(files("beltdyn") / "examples" / "accessory_drive.toml"))
    fine = accessory.belt.replace(elements=300)
    return {"case 2": (case_2, case_2), "accessory drive": (accessory, accessory.replace(belt=fine))}


def seconds(analyse: Callable[[Drive], object], drive: Drive, rounds: int) -> float:
    """Median time of an analysis, s."""
    taken = []
    for _ in range(rounds):
        begun = time.perf_counter()
        analyse(drive)
        taken.append(time.perf_counter() - begun)
    return statistics.median(taken)


def main() -> None:
    """Print the table."""
    table = Table(
        "drive", "elements", "iterations", "search ms", "all ms", "over time s", "ratio", title="Steady running"
    )
    for name, (drive, over_time) in drives().items():
        found = steady_state(drive).dataset
        whole = seconds(steady_state, drive, ROUNDS)
        search = statistics.median(float(steady_state(drive).dataset.attrs["wall_time"]) for _ in range(ROUNDS))
        run = float(simulate(over_time).dataset.attrs["wall_time"])
        numbers = f"{1e3 * search:.0f}", f"{1e3 * whole:.0f}", f"{run:.2f}", f"{run / whole:.0f}"
        table.add_row(name, str(found.sizes["node"]), str(found.attrs["newton_iterations_of_search"]), *numbers)
    Console().print(table)


if __name__ == "__main__":
    main()

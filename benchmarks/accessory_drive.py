"""Time of one simulated second of the accessory drive among the examples: seven pulleys, 150 elements, one core.

The second holds start, flare, overrunning clutch and idle.  Compilation is apart.  Wall time grows with what else the
machine does; the time of the processor does not.
"""

import statistics
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table

import beltdyn
from beltdyn import simulate
from beltdyn.model import load

ROUNDS = 3
ALLOWED = 10.0
"""Seconds that a simulated second may take."""


def main() -> None:
    """Print the table."""
    drive = load(Path(beltdyn.__file__).parent / "examples" / "accessory_drive.toml")
    settings = drive.simulation
    simulate(drive.replace(simulation=settings.replace(duration=2 * settings.output_interval)))
    second = drive.replace(simulation=settings.replace(duration=1.0))
    walls, processor = [], []
    for _ in range(ROUNDS):
        wall, start = time.perf_counter(), time.process_time()
        attributes = simulate(second).dataset.attrs
        walls.append(time.perf_counter() - wall)
        processor.append(time.process_time() - start)
    wall, used = statistics.median(walls), statistics.median(processor)
    table = Table("quantity", "value", title=f"{len(drive.pulleys)} pulleys, {drive.elements} elements, 1 s")
    table.add_row("wall time", f"{wall:.2f} s, {min(walls):.2f} to {max(walls):.2f}")
    table.add_row("time of the processor", f"{used:.2f} s, {min(processor):.2f} to {max(processor):.2f}")
    table.add_row("computing time for a simulated second", f"{attributes['wall_time']:.2f} s")
    table.add_row("steps + rejected", f"{attributes['steps']} + {attributes['rejected_steps']}")
    table.add_row("Newton iterations", str(attributes["newton_iterations"]))
    Console().print(table)
    Console().print(f"{'Within' if used < ALLOWED else 'MORE THAN'} the {ALLOWED:g} s that a second may take.")


if __name__ == "__main__":
    main()

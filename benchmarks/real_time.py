"""Real-time factor of the two-pulley drive of the paper: seconds of computing for each simulated second, one thread.

Compilation is apart.  Settings are run in turn, several times over; medians are printed, with their ratio to the first.
"""

import statistics

from rich.console import Console
from rich.table import Table

from beltdyn import simulate
from beltdyn.model import Drive
from validation.published import two_pulley

ROUNDS = 5


def settings() -> dict[str, Drive]:
    """The drives to time, by a name."""
    published = two_pulley()
    zone = {"contact": published.contact.replace(integration="zone")}
    still = {**zone, "simulation": published.simulation.replace(start="equilibrium")}
    return {
        "20 elements, laid, fixed points (published)": published,
        "20 elements, laid, zone (demo)": published.replace(**zone),
        "20 elements, equilibrium, zone": published.replace(**still),
        "60 elements, equilibrium, zone": two_pulley(60).replace(**still),
    }


def main() -> None:
    """Print the table."""
    drives = settings()
    factors: dict[str, list[float]] = {name: [] for name in drives}
    steps = {}
    for _ in range(ROUNDS):
        for name, drive in drives.items():
            attributes = simulate(drive).dataset.attrs
            factors[name].append(float(attributes["wall_time"]) / drive.simulation.duration)
            steps[name] = f"{attributes['steps']} + {attributes['rejected_steps']}"
    table = Table(
        "drive", "s for each simulated s", "spread", "ratio", "steps + rejected", title="Two-pulley drive, 1 s"
    )
    first = statistics.median(next(iter(factors.values())))
    for name, values in factors.items():
        median = statistics.median(values)
        spread = f"{min(values):.3f} to {max(values):.3f}"
        table.add_row(name, f"{median:.3f}", spread, f"{median / first:.2f}", steps[name])
    Console().print(table)


if __name__ == "__main__":
    main()

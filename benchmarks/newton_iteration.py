"""Cost of one Newton iteration (tangent, contact, linear solve) over the number of elements, in one thread.

Prints microseconds per iteration and element, and the fitted growth: cost ~ elements^p, p = 1 being linear.
"""

import statistics
import time

import numpy as np
from rich.console import Console
from rich.table import Table

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.model import Drive, prepare
from beltdyn.state.installation import bring_to_rest
from beltdyn.system.arrays import Equations, Motion, System, TangentFactors
from beltdyn.system.build import drive_system
from beltdyn.system.ring_matrix import solve_ring
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers
from validation.published import two_pulley

ELEMENTS = (20, 40, 80, 160, 320, 640)
ITERATIONS = 20_000
ROUNDS = 7


@kernel
def iterate(system: System, motion: Motion, equations: Equations, none: FloatArray, count: int) -> None:
    """Linearize and solve at the same state again and again, as an integrator with steps of a millisecond does."""
    for _ in range(count):
        assemble(system, motion, none, TangentFactors(1.0, 2e3, 4e6, False), equations)
        solve_ring(equations.matrix, system.closed, equations.node_part, equations.border_part)


def time_iterations(drive: Drive) -> list[float]:
    """Microseconds per iteration of each round, on the belt in equilibrium on its pulleys."""
    system = drive_system(prepare(drive))
    state = bring_to_rest(drive).state
    motion = Motion(0.0, state.position, np.zeros_like(state.position), np.zeros_like(state.position))
    equations, none = new_equations(system), no_multipliers(system)
    count = ITERATIONS // system.nodes
    iterate(system, motion, equations, none, 1)
    rounds = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        iterate(system, motion, equations, none, count)
        rounds.append((time.perf_counter() - begun) / count * 1e6)
    return rounds


def drive_of(elements: int, integration: str) -> Drive:
    """The paper's drive."""
    drive = two_pulley(elements)
    return drive.replace(contact=drive.contact.replace(integration=integration))


def main() -> None:
    """Print the table and the fit."""
    console = Console()
    for integration in ("zone", "fixed"):
        table = Table("elements", "µs per iteration and element", "spread", title=f"Newton iteration, {integration}")
        medians = []
        for elements in ELEMENTS:
            rounds = [time / elements for time in time_iterations(drive_of(elements, integration))]
            medians.append(statistics.median(rounds))
            table.add_row(f"{elements}", f"{medians[-1]:.2f}", f"{min(rounds):.2f} to {max(rounds):.2f}")
        growth = np.polyfit(np.log(ELEMENTS), np.log(np.array(medians) * ELEMENTS), 1)[0]
        console.print(table)
        console.print(f"cost of an iteration ~ elements^{growth:.3f}\n", highlight=False)


if __name__ == "__main__":
    main()

"""Where the time of a Newton iteration goes, and that of observing a state: microseconds per element, one thread.

The paper's drive in equilibrium, half of its elements on the pulleys; smallest of several rounds.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import ContactFactors, contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.elements import elastic_force
from beltdyn.kernel import kernel
from beltdyn.model import prepare
from beltdyn.state.installation import bring_to_rest
from beltdyn.system.arrays import NO_TANGENT, Equations, Motion, System, TangentFactors
from beltdyn.system.build import drive_system
from beltdyn.system.element_state import centreline, gather
from beltdyn.system.moving_center import pulley_state
from beltdyn.system.observe import observe
from beltdyn.system.ring_matrix import factorise_ring, substitute
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers
from validation.published import better, two_pulley

ROUNDS, REPEATS = 15, 300
FACTORS = ContactFactors(1.0, 2e3, 2e3, 0.0, 0.0, False)


@kernel
def repeat_assembly(system: System, motion: Motion, work: Equations, none: FloatArray) -> None:
    """Residual and tangent."""
    for _ in range(REPEATS):
        assemble(system, motion, none, TangentFactors(1.0, 2e3, 4e6, False), work)


@kernel
def repeat_residual(system: System, motion: Motion, work: Equations, none: FloatArray) -> None:
    """Residual alone."""
    for _ in range(REPEATS):
        assemble(system, motion, none, NO_TANGENT, work)


@kernel
def repeat_factors(system: System, _motion: Motion, work: Equations, _none: FloatArray) -> None:
    """Factorize the tangent."""
    for _ in range(REPEATS):
        factorise_ring(work.matrix, system.closed)


@kernel
def repeat_substitution(system: System, _motion: Motion, work: Equations, _none: FloatArray) -> None:
    """Solve with factors."""
    for _ in range(REPEATS):
        substitute(work.matrix, system.closed, work.node_part, work.border_part)


@kernel
def repeat_elasticity(system: System, motion: Motion, work: Equations, _none: FloatArray) -> None:
    """Elastic forces with their tangent."""
    scratch = work.work
    for _ in range(REPEATS):
        for element in range(system.length.size):
            gather(system, element, motion.position, scratch.coordinates[0])
            elastic_force(system.element, scratch.coordinates[0], system.length[element], True, scratch.element)


@kernel
def repeat_contact(system: System, motion: Motion, work: Equations, _none: FloatArray) -> None:
    """Contact forces with their tangent."""
    scratch, points = work.work, system.contact
    for _ in range(REPEATS):
        for element in range(system.length.size):
            gather(system, element, motion.position, scratch.coordinates[0])
            gather(system, element, motion.velocity, scratch.coordinates[1])
            piece = centreline(system, element, 0, scratch)
            for p in range(system.pulleys.size):
                pulley = pulley_state(system, p, motion.position, motion.velocity)
                if not out_of_reach(piece.control, pulley):
                    contact_force(piece, pulley, system.law, points, FACTORS, scratch.contact)


def smallest(run: Callable[[], object]) -> float:
    """Seconds of the fastest round."""
    run()
    times = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        run()
        times.append(time.perf_counter() - begun)
    return min(times)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--elements", type=int, default=20)
    elements = parser.parse_args().elements
    drive = better(two_pulley(elements))
    system = drive_system(prepare(drive))
    state = bring_to_rest(drive).state.position
    motion = Motion(0.0, state, np.zeros_like(state), np.zeros_like(state))
    arguments = (system, motion, new_equations(system), no_multipliers(system))
    table = Table("part", "µs per element", title=f"{elements} elements")
    parts = {
        "assembly": repeat_assembly,
        "  of it elasticity": repeat_elasticity,
        "  of it contact": repeat_contact,
        "factors": repeat_factors,
        "substitution": repeat_substitution,
        "residual alone": repeat_residual,
    }
    for name, part in parts.items():
        seconds = smallest(lambda part=part: part(*arguments))  # type: ignore[misc]
        table.add_row(name, f"{1e6 * seconds / REPEATS / elements:.2f}")
    states, times = np.tile(state, (REPEATS, 1)), np.zeros(REPEATS)
    seconds = smallest(lambda: observe(system, times, states, np.zeros_like(states)))
    table.add_row("observing a state", f"{1e6 * seconds / REPEATS / elements:.2f}")
    Console().print(table)


if __name__ == "__main__":
    main()

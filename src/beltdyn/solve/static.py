"""Static equilibrium of a belt: Newton's method, globalised by an inertial shift of the stiffness (section 5 of the paper).

The step solves (K + shift M) x = residual.  A large shift makes small, safe steps along the forces; none makes Newton's step.  The
shift falls while steps lower the energy and rises when one does not.  The change of energy is taken as the work of the mean of
the forces before and after the step, so that it holds for friction and moments too, which have no potential.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from beltdyn.errors import ConvergenceError
from beltdyn.system.arrays import NODE, FloatArray, System
from beltdyn.system.motion import Equations, linearise, new_equations, subtract_solution
from beltdyn.system.state import State



_TOLERANCE = 1e-11
_LARGEST_SHIFT = 1e12
_SMALLEST_SHIFT = 1e-6


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A static equilibrium, and how it was found.

    Parameters
    ----------
    state
        At rest.
    iterates : ndarray, shape (iterations + 1, N, 6)
        Nodal coordinates from the start to the equilibrium.
    norms : ndarray, shape (iterations,)
        Energy norm of the steps, as a mean strain of the belt: sqrt(residual . step / (E A alpha1 L)).
    """

    state: State
    iterates: FloatArray
    norms: FloatArray

    @property
    def iterations(self) -> int:
        """Number of iterations."""
        return len(self.norms)


def find_equilibrium(
    system: System,
    start: State,
    *,
    method: Literal["globalised", "newton"] = "globalised",
    max_iterations: int = 500,
) -> Equilibrium:
    """Find the static equilibrium that a belt falls into from a start.

    Pulleys do not move: the belt slides on them without friction, unless `start` gives them speeds, which then rub the belt at rest.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    start
        Where to begin; its belt must be at rest.
    method
        "globalised", or "newton" for the plain iteration of the paper.
    max_iterations
        Most iterations, 500 by default.

    Returns
    -------
    Equilibrium
        The state with its iterates.

    Raises
    ------
    ConvergenceError
        If the iteration does not end, or the stiffness is singular.
    """
    search = _Search(system, start)
    shift = 1.0 if method == "globalised" else 0.0
    iterates, norms = [start.nodes(system).copy()], list[float]()
    while len(norms) < max_iterations and shift < _LARGEST_SHIFT:
        norm = search.solve(shift)
        if method == "newton":
            search.step()
        elif not search.step_downhill():
            shift = max(10.0 * shift, _SMALLEST_SHIFT)
            continue
        iterates.append(search.nodes.copy())
        norms.append(norm)
        if shift == 0.0 and norm < _TOLERANCE:
            position = np.concatenate([search.nodes.ravel(), start.position[search.nodes.size :]])
            state = State(position, start.velocity.copy(), np.zeros_like(position))
            return Equilibrium(state, np.array(iterates), np.array(norms))
        shift = 0.1 * shift if shift > _SMALLEST_SHIFT else 0.0
    last = f"{norms[-1]:.1e}" if norms else "none"
    raise ConvergenceError(
        f"static equilibrium not found after {len(norms)} iterations (last step, as a mean strain: {last}; "
        f"{_TOLERANCE:.0e} wanted). Start nearer to it, or give the belt more elements."
    )


class _Search:
    """A belt on its way to equilibrium, with the linearised equations where it stands."""

    def __init__(self, system: System, start: State) -> None:
        still = np.full_like(system.pulleys.unknown, -1)
        self._system = system._replace(pulleys=system.pulleys._replace(unknown=still))
        self._position, self._velocity = start.position.copy(), start.velocity
        self._equations: Equations = new_equations(self._system)
        self._length = float(np.sum(system.length))
        self._time_scale = self._length**2 * system.section.mass / system.section.axial

    @property
    def nodes(self) -> FloatArray:
        """Nodal coordinates, shape (N, 6)."""
        return self._position[: NODE * self._system.nodes].reshape(-1, NODE)

    def solve(self, shift: float) -> float:
        """Linearise where the belt stands, with an inertial shift relative to axial waves; energy norm of the step."""
        at_rest = np.zeros_like(self._position)
        solved = linearise(
            self._system,
            0.0,
            self._position,
            self._velocity,
            at_rest,
            np.zeros(NODE),
            1.0,
            0.0,
            shift / self._time_scale,
            self._equations,
        )
        self._residual = self._equations.matrix.node_side.copy()
        self._step = self._equations.node_part.copy()
        if not solved or not np.all(np.isfinite(self._step)):
            self._step[:] = np.nan
        energy = abs(float(np.sum(self._residual * self._step)))
        return float(np.sqrt(energy / (self._system.section.axial * self._length)))

    def step(self) -> None:
        """Take the step."""
        subtract_solution(self._system, self._equations, 1.0, self._position)

    def step_downhill(self) -> bool:
        """Take the step if the forces do work on the way; stay otherwise."""
        before, residual, step = self._position.copy(), self._residual, self._step
        if np.all(np.isfinite(step)):
            self.step()
            self.solve(0.0)
            work = 0.5 * float(np.sum((residual + self._residual) * step))
            if work > 0.0 or np.linalg.norm(self._residual) < np.linalg.norm(residual):
                return True
        self._position = before
        return False

"""Static equilibrium of a belt: Newton's method, damped by the natural monotonicity test (section 5 of the paper).

A belt is so much stiffer in tension than in bending that neither the energy nor the residual falls along a good path to
equilibrium.  What must fall is the next correction as the present stiffness sees it (Deuflhard 2011, section 2.1):
a step of length d is taken if |K^-1 r(q - d x)| <= (1 - d / 4) |x| with x = K^-1 r(q).  Where no length will do, or
the stiffness is singular, a multiple of the mass matrix is added to the stiffness for a while.  A belt of many short
links slides around its pulleys almost without resistance, which leaves steps that mean nothing; there the forces tell
that the search is over.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from beltdyn.arrays import FloatArray, Records
from beltdyn.errors import ConvergenceError
from beltdyn.solvers.engine import correct, linearise
from beltdyn.solvers.time_limit import spend_time
from beltdyn.system.arrays import Equations, Motion, System, TangentFactors
from beltdyn.system.meshing import phases, turning_grooves, unloaded
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import new_equations, no_multipliers

_STATE_TOLERANCE = 1e-11
"""Energy norm of the last step of Newton's method, as a mean strain of the belt, at which equilibrium is found. The
error that it leaves is smaller still: convergence is quadratic."""
_FORCE_TOLERANCE = 1e-11
"""Of nodal forces over E A alpha1."""
_SMALLEST_SHIFT, _LARGEST_SHIFT = 1e-6, 1e12
"""Inertial shift of the tangent over (wave speed / belt length) squared, where steps do not succeed without: the first
one, below which it is zero, and that beyond which the search fails."""
_MIN_STEP_PART = 1e-2
"""Least part of a step that is tried, after six halvings; below, the shift is increased."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A static equilibrium, with nodal coordinates of its iterates, shape (iterations + 1, N, 6).

    `norms` are energy norms of the steps, as a mean strain of the belt: sqrt(residual . step / (E A alpha1 L)).
    """

    state: State
    iterates: FloatArray
    norms: FloatArray
    phases: FloatArray
    """Phases of the grooves of pulleys, rad, of a belt with teeth, or none."""

    @property
    def iterations(self) -> int:
        """Number of iterations."""
        return len(self.norms)


def find_equilibrium(
    system: System,
    start: State,
    *,
    method: Literal["globalized", "newton"] = "globalized",
    max_iterations: int = 500,
    torque: FloatArray | None = None,
) -> Equilibrium:
    """Find a static equilibrium of a belt from a resting initial state; "newton" is the plain iteration of the paper.

    Pulleys do not turn: the belt slides on them without friction, unless `start` gives them speeds, with which they rub
    on the resting belt. Grooves of toothed pulleys turn to where teeth do not turn the pulley, or hold its `torque`
    (N m, shape (P,)). Tensioners move. `tensioner_compliance` shows whether the equilibrium is stable.
    """
    search = _Search(system, start, torque)
    shift = 0.0
    iterates, norms = [start.nodes(system).copy()], list[float]()
    while len(norms) < max_iterations and shift < _LARGEST_SHIFT:
        spend_time()
        norm = search.linearise(shift)
        converged = shift == 0.0 and norm < _STATE_TOLERANCE
        if method == "newton" or converged:
            search.step(1.0)
        elif not search.step_naturally():
            converged = search.force < _FORCE_TOLERANCE
            if not converged:
                shift = max(10.0 * shift, _SMALLEST_SHIFT)
                continue
        iterates.append(search.nodes.copy())
        norms.append(norm)
        if converged:
            state = State(search.position.copy(), start.velocity.copy(), np.zeros_like(search.position))
            return Equilibrium(state, np.array(iterates), np.array(norms), search.phases)
        shift = 0.1 * shift if shift > _SMALLEST_SHIFT else 0.0
    last = f"relative movement {norms[-1]:.1e} after {len(norms)} iterations" if norms else "the search diverges"
    raise ConvergenceError(
        f"no static equilibrium found: {last}. Change the belt tension or length, omit contact.stiffness and "
        "belt.elements so that they are chosen, or increase belt.elements."
    )


def standing(system: System) -> System:
    """The same system with prescribed shafts that stand still, as static equilibrium has it."""
    segments, starts = system.profiles.segment.copy(), system.profiles.table["segment"]
    for pulley in np.flatnonzero(system.bodies["unknown"][system.pulleys.shaft] < 0):
        for name in ("offset", "slope", "curvature", "amplitude"):
            segments[name][starts[pulley] : starts[pulley + 1]] = 0.0
    return system._replace(profiles=system.profiles._replace(segment=segments))


def tensioner_compliance(system: System, state: State) -> FloatArray:
    """Displacements of tensioners by forces on them, the belt in equilibrium, shape (K, K); m/N, rad/(N m) or 1/N.

    The inverse of what elimination of the belt leaves of the stiffness, NaN where that is singular. It is positive
    definite where the balance of the tensioners is stable: the second variation of the energy, the belt following.
    """
    search, count = _Search(system, state), system.tensioners.size
    search.linearise(0.0)
    return np.array([search.answer_to_force(number) for number in range(count)]).reshape(count, count)


class _Search:
    """Belt and tensioners on their way to equilibrium, with the linearized equations where they stand."""

    def __init__(self, system: System, start: State, torque: FloatArray | None = None) -> None:
        self._system = unloaded(system._replace(bodies=only_tensioners(system)), torque)
        self._grooves = turning_grooves(system)
        self.position, self._velocity = start.position.copy(), start.velocity
        self._multipliers = no_multipliers(system)
        self._here: Equations = new_equations(self._system)
        self._ahead: Equations = _with_sides_of_its_own(self._here)
        self._length = float(np.sum(system.length))
        self._time_scale = self._length**2 * system.element.section.mass / system.element.section.axial
        self._scale = system.scale
        self._count = system.tensioners.size
        tensioners = np.arange(system.bodies.size - self._count, system.bodies.size)
        self._reach = system.bodies.reach[np.append(tensioners, self._grooves)]

    @property
    def nodes(self) -> FloatArray:
        """Nodal coordinates, shape (N, n)."""
        return self.position[: self._system.first_body].reshape(self._system.nodes, -1)

    @property
    def phases(self) -> FloatArray:
        """Phases of grooves, rad, shape (P,), or none."""
        return phases(self._system).copy()

    @property
    def force(self) -> float:
        """Largest force out of balance where the equations were linearized last, over E A alpha1."""
        nodes = np.abs(self._here.matrix.node_side / self._scale)
        bodies = np.abs(self._here.matrix.border_side[: self._reach.size] / self._reach)
        return max(float(np.max(nodes)), float(np.max(bodies, initial=0.0))) / self._system.element.section.axial

    def linearise(self, shift: float) -> float:
        """Linearize where the belt stands, with an inertial shift relative to axial waves; energy norm of the step.

        It is nan where the stiffness is singular.
        """
        matrix, here = self._here.matrix, self._here
        shift /= self._time_scale
        factors = TangentFactors(by_position=1.0, by_acceleration=shift)
        if not linearise(self._system, self._motion, self._multipliers, factors, here):
            here.node_part[:] = np.nan
        energy = abs(float(np.sum(matrix.node_side * here.node_part) + matrix.border_side @ here.border_part))
        return float(np.sqrt(energy / (self._system.element.section.axial * self._length)))

    def step(self, length: float) -> None:
        """Take the step, or a part of it."""
        nodes, border, bodies = self._system.first_body, self._here.border_part, self._reach.size
        self.position[:nodes] -= length * self._here.node_part.ravel()
        self.position[self.position.size - self._count :] -= length * border[: self._count]
        if self._grooves.size:
            phases(self._system)[self._grooves] -= length * border[self._count : bodies]
        if self._system.joint:
            self._multipliers -= length * border[bodies:]

    def step_naturally(self) -> bool:
        """Take the longest of halved steps that passes the natural monotonicity test; False if there is none."""
        size, length = self._size(self._here), 1.0
        while np.isfinite(size) and length >= _MIN_STEP_PART:
            self.step(length)
            correct(self._system, self._motion, self._multipliers, self._ahead)
            if self._size(self._ahead) <= (1.0 - 0.25 * length) * size:
                return True
            self.step(-length)
            length *= 0.5
        return False

    def answer_to_force(self, number: int) -> FloatArray:
        """How far tensioners move by a unit of force on one of them, from where the equations were linearized."""
        tensioners = self._system.tensioners.copy()
        tensioners["push"][number] += 1.0
        correct(self._system._replace(tensioners=tensioners), self._motion, self._multipliers, self._ahead)
        return np.asarray((self._here.border_part - self._ahead.border_part)[: tensioners.size])

    @property
    def _motion(self) -> Motion:
        """Where the belt stands, the speeds of pulleys that rub it, and no acceleration."""
        return Motion(0.0, self.position, self._velocity, np.zeros_like(self.position))

    def _size(self, equations: Equations) -> float:
        """Root mean square of a step of the nodes, or the largest step of a tensioner or groove, m."""
        nodes = float(np.sqrt(np.mean((equations.node_part * self._scale) ** 2)))
        bodies = np.abs(equations.border_part[: self._reach.size] * self._reach)
        return float(np.max(bodies, initial=nodes))


def _with_sides_of_its_own(equations: Equations) -> Equations:
    """Equations with the same tangent, but another right-hand side and solution."""
    matrix, node_part, border_part = equations.matrix, equations.node_part, equations.border_part
    return equations._replace(
        matrix=matrix._replace(node_side=np.zeros_like(node_part), border_side=np.zeros_like(border_part)),
        node_part=np.zeros_like(node_part),
        border_part=np.zeros_like(border_part),
    )


def only_tensioners(system: System) -> Records:
    """The bodies when nothing turns and tensioners move."""
    bodies, count = system.bodies.copy(), system.tensioners.size
    bodies["unknown"] = -1
    bodies["unknown"][bodies.size - count :] = np.arange(count)
    return bodies

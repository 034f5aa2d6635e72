"""The single compiled entry point of everything that solves the equations of motion.

A kernel that Python calls is compiled whole, with all that it calls.  Linearizing, for statics and for starts, and
stepping through time share most of their code; with a single entry point it is compiled once.
"""

from math import inf, nextafter
from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.kernel import kernel
from beltdyn.solvers import alpha_advance
from beltdyn.solvers.integrator_state import (
    IntegratorState,
    Settings,
    Steps,
    empty_steps,
    motion_of,
    new_state,
    trial_motion,
)
from beltdyn.system.arrays import DRIVER_WORK, NO_TANGENT, Equations, Motion, System, TangentFactors
from beltdyn.system.body_forces import prescribe
from beltdyn.system.missed_action import jump_work
from beltdyn.system.ring_matrix import solve_ring, substitute
from beltdyn.system.steady_assembly import assemble, subtract_multipliers, subtract_solution

ADVANCE: Final = 0
"""Step through time."""
LINEARISE: Final = 1
"""Assemble at the trial state of the integration, and solve."""
ACCELERATE: Final = 2
"""Prescribe the motion of what is driven, linearize, and put the solution into the trial acceleration."""
CORRECT: Final = 3
"""Assemble the residual alone at the trial state of the integration, and solve with the factors that are there."""

_NO_SETTINGS = Settings(0.0, 1.0, 1.0, 1.0)


class Request(NamedTuple):
    """A request to the engine, with its parameters."""

    kind: int
    time: float = 0.0
    """Where the last step ends, or where to linearize, s."""
    budget: int = 0
    """Steps to try at most."""
    factors: TangentFactors = NO_TANGENT


@kernel
def dispatch(
    system: System, request: Request, settings: Settings, state: IntegratorState, equations: Equations, steps: Steps
) -> tuple[int, int]:
    """Execute the request.

    `request`: what to do; `settings`, `state`, `steps`: as for `alpha_advance.advance`; `equations`: arrays to work in.
    Returns status, filled: those of `alpha_advance.advance`; of others 1, or 0 where the tangent is singular, and 0.
    """
    kind, trial = request.kind, state.trial
    if kind == ADVANCE:
        return alpha_advance.advance(system, settings, state, equations, request.time, request.budget, steps)
    motion = trial_motion(state, request.time)
    if kind == ACCELERATE:
        prescribe(system, motion)
    assemble(system, motion, state.multipliers, request.factors, equations)
    if kind == CORRECT:
        substitute(equations.matrix, system.closed, equations.node_part, equations.border_part)
        return 1, 0
    if not solve_ring(equations.matrix, system.closed, equations.node_part, equations.border_part):
        return 0, 0
    if kind == ACCELERATE:
        subtract_solution(system, equations, 1.0, trial.acceleration)
        subtract_multipliers(system, equations, 1.0, state.multipliers)
    return 1, 0


def advance(
    system: System,
    settings: Settings,
    state: IntegratorState,
    equations: Equations,
    stop: float,
    budget: int,
    steps: Steps,
) -> tuple[int, int]:
    """Integrate; see `alpha_advance.advance`."""
    return dispatch(system, Request(ADVANCE, stop, budget), settings, state, equations, steps)


def linearise(
    system: System, motion: Motion, multipliers: FloatArray, factors: TangentFactors, equations: Equations
) -> bool:
    """Assemble the equations at a state and solve tangent x = residual; arguments as for `assemble`."""
    return _dispatch_at(system, Request(LINEARISE, motion.time, factors=factors), motion, multipliers, equations)


def correct(system: System, motion: Motion, multipliers: FloatArray, equations: Equations) -> None:
    """Solve tangent x = residual at a state with the tangent of another, which `linearise` left in the equations."""
    _dispatch_at(system, Request(CORRECT, motion.time), motion, multipliers, equations)


def accelerate(system: System, motion: Motion, multipliers: FloatArray, equations: Equations) -> bool:
    """Accelerations and multipliers of the equations of motion (Eq. 25; Eq. 27 where nodes are shared).

    Both are overwritten, with the motion of prescribed bodies and the body forces of the state. False if the mass
    matrix is singular.
    """
    motion.acceleration[:] = 0.0
    multipliers[:] = 0.0
    request = Request(ACCELERATE, motion.time, factors=TangentFactors(by_acceleration=1.0))
    return _dispatch_at(system, request, motion, multipliers, equations)


def _dispatch_at(
    system: System, request: Request, motion: Motion, multipliers: FloatArray, equations: Equations
) -> bool:
    """Execute the request at a state, changed in place; False if the tangent is singular."""
    size, vectors = motion.position.size, (motion.position, motion.velocity, motion.acceleration)
    state = new_state(system, request.time, 0.0, np.zeros(size), np.zeros(size))._replace(multipliers=multipliers)
    for own, given in zip(state.trial, vectors, strict=False):
        own[:] = given
    solved = dispatch(system, request, _NO_SETTINGS, state, equations, empty_steps(system, 0))[0] == 1
    for changed, vector in zip(vectors, state.trial, strict=False):
        changed[:] = vector
    return solved


def restart(system: System, state: IntegratorState, equations: Equations) -> None:
    """Take the accelerations from the equations of motion: at the start, and after a jump of what drives the system."""
    after = motion_of(state)._replace(time=nextafter(state.clock.time, inf))
    speeds = state.velocity.copy()
    if not accelerate(system, after, state.multipliers, equations):
        raise ConvergenceError(
            "a moving part of the drive has no mass. Give belt, pulleys, tensioners and hubs mass or inertia."
        )
    state.auxiliary[:] = state.acceleration
    state.trend[:] = state.clock.persistence = 0.0
    state.lagged[:] = np.nan
    state.work[DRIVER_WORK] += jump_work(system, speeds, state.velocity)
    state.power[:] = equations.forces.power

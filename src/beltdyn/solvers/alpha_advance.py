"""Generalized-alpha time integration with variable steps, in compiled code.

The local error of the position is (beta + (am - af) / 2 - 1/6) h^2 (A1 - A0) to leading order.  It is
allowed in proportion to the length of the step; but not beyond a length at which errors that pull the same way would
add up to what the tension of the belt feels.  With tight tolerances, what numerical damping takes is kept to a part of
the physical losses as well.
"""

from math import ceil, floor, inf, sqrt
from typing import Final

import numpy as np

from beltdyn.kernel import kernel
from beltdyn.solvers.alpha_step import Method, Step, follow_torques, follow_trend, method_of, new_step, try_step
from beltdyn.solvers.integrator_state import (
    IntegratorState,
    Settings,
    Steps,
    allowed_error,
    motion_of,
    resolved_length,
    trial_motion,
)
from beltdyn.system.arrays import (
    FRICTION_LOSS,
    NUMERICAL_LOSS,
    BodyForces,
    Equations,
    System,
)
from beltdyn.system.body_forces import find_body_forces, keep_body_forces
from beltdyn.system.missed_action import missed_work, numerical_loss

REACHED: Final = 0
"""Status: the stop was reached, the room for steps is full, or the budget is spent."""
STEP_TOO_SMALL: Final = 1
"""Status: no step was found that converges and is accurate."""
STRETCH: Final = 1.2
"""A step may exceed the wanted one by this factor, so that it ends on an instant."""

_GROWTH_ITERATIONS: Final = 5
"""Newton iterations of a step up to which the next may be longer: after more, a longer one might not converge."""
_MAX_GROWTH: Final = 2.0
"""Largest factor from a step to the next: the error of a step tells little of that of a much longer one."""
_MIN_REDUCTION: Final = 0.2
"""Least factor from a step to the next: one large error, as where nodes meet a pulley, must not stop the run."""
_TARGET_ERROR: Final = 0.8
"""Local error, over that allowed, for which steps are chosen; the margin avoids repeated steps."""
_LARGEST_ERROR: Final = 4.0
"""Local error, over that allowed, up to which a step is taken: errors jump as nodes meet pulleys, and a step tried
again costs more than it gains."""
_WORST: Final = 3.0
"""A node may err by this many times the root mean square allowed of all: errors are largest at the few nodes that meet
pulleys, and would vanish in the mean of a fine mesh."""
_TIGHTEST: Final = 27.0
"""Steps may be three times shorter for the sake of the losses than the local error asks for."""
SMALLEST_STEP: Final = 1e-11
"""Length of a step, s, below which the integration fails: far below 1e-7 s, within which any change is an impulse to a
belt."""


@kernel
def advance(
    system: System,
    settings: Settings,
    state: IntegratorState,
    equations: Equations,
    stop: float,
    budget: int,
    steps: Steps,
) -> tuple[int, int]:
    """Integrate until a stop, until there is no room for steps, or until a number of steps has been tried.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    settings
        Tolerances and the method's parameter.
    state
        Changed in place; it stands on the last state reached.
    equations
        Arrays to work in.
    stop
        Instant on which the last step ends, s: a kink or jump of what drives the system, or the end.
    budget
        Steps to try at most, so that the caller hears of progress.
    steps
        Filled with the steps that are accepted.

    Returns
    -------
    status : int
        `REACHED` or `STEP_TOO_SMALL`.
    filled : int
        Number of steps filled.
    """
    filled = 0
    method = method_of(settings.spectral_radius)
    clock = state.clock
    for _ in range(budget):
        if clock.time >= stop or (filled == steps.time.size and filled > 0):
            break
        length = resolved_length(system, settings, motion_of(state), _next_step(clock, settings, stop))
        step = new_step(method, clock.time, length, stop)
        iterations = try_step(system, settings, method, state, step, equations)
        if iterations == 0:
            state.counts.failed += 1
            following = 0.5 / STRETCH * length
        else:
            error = _local_error(system, settings, method, state, length)
            growth = _MAX_GROWTH if iterations <= _GROWTH_ITERATIONS else 1.0
            wanted = max(error, min(_TIGHTEST * error, _loss_error(settings, state, length)))
            factor = min(growth, max(_MIN_REDUCTION, (_TARGET_ERROR / max(wanted, 1e-12)) ** (1.0 / 3.0)))
            if error > _LARGEST_ERROR:
                state.counts.rejected += 1
                factor /= STRETCH
            else:
                state.counts.steps += 1
                _accept(system, settings, method, state, equations, step)
                filled = _keep(state, step, equations.forces, steps, filled)
            following = min(settings.max_step, factor * length)
        clock.next_step = following
        if following < SMALLEST_STEP:
            return STEP_TOO_SMALL, filled
    return REACHED, filled


@kernel(inline=True)
def _next_step(clock: np.record, settings: Settings, stop: float) -> float:
    """One of the equal steps to the stop, or to the last output instant that one step reaches, or else to the next."""
    wanted, interval, since = clock.next_step, settings.output_interval, clock.time - settings.output_begin
    longest = min(settings.max_step, STRETCH * wanted)
    following = floor((since + 0.5 * wanted) / interval) + 1.0
    reached = floor((since + longest) / interval)
    end = settings.output_begin + max(following, reached) * interval if interval < inf else stop
    left = min(stop, end) - clock.time
    return float(left / ceil(left / longest * (1.0 - 1e-6)))


@kernel(inline=True)
def _local_error(system: System, settings: Settings, method: Method, state: IntegratorState, step: float) -> float:
    """Local error of the positions over what is allowed: of all nodes in the mean, of the worst node, of each body."""
    auxiliary, total, worst = state.trial.auxiliary, 0.0, 0.0
    for node in range(system.nodes):
        square = 0.0
        for c in range(2 * system.points):
            i = len(system.scale) * node + c
            square += (auxiliary[i] - state.auxiliary[i]) ** 2
        total, worst = total + square, max(worst, square)
    largest = max(sqrt(total / (system.nodes * system.points)), sqrt(worst / system.points) / _WORST)
    for body in range(system.bodies.size):
        if system.bodies[body].unknown >= 0:
            i = system.first_body + body
            largest = max(largest, system.bodies[body].reach * abs(auxiliary[i] - state.auxiliary[i]))
    return method.error * step * step * largest / allowed_error(settings, step)


@kernel(inline=True)
def _loss_error(settings: Settings, state: IntegratorState, length: float) -> float:
    """What numerical damping takes of the losses with steps of a length, over what is allowed."""
    if state.losses.physical <= 0.0:
        return 0.0
    return float(state.losses.numerical * length**3 / (settings.numerical_share * state.losses.physical))


@kernel(inline=True)
def _average_losses(settings: Settings, state: IntegratorState, length: float, taken: float) -> None:
    """Take the powers at the end of a step, and what numerical damping took in it (J), into their means."""
    part, lost = length / (length + settings.averaging_time), 0.0
    for k in range(FRICTION_LOSS, NUMERICAL_LOSS):
        lost += state.power[k]
    state.losses.physical += part * (lost - state.losses.physical)
    state.losses.numerical += part * (taken / length**4 - state.losses.numerical)


@kernel(inline=True)
def _accept(
    system: System, settings: Settings, method: Method, state: IntegratorState, equations: Equations, step: Step
) -> None:
    """Move to the end of the step, and do the energy account."""
    work, corner, power = equations.work, equations.matrix.corner, equations.forces.power
    end = trial_motion(state, step.end)
    find_body_forces(system, end, work, corner, equations.forces)
    taken = numerical_loss(system, motion_of(state), end, state.impulse, work)
    state.work[NUMERICAL_LOSS] += taken
    missed_work(system, motion_of(state), end, state.impulse, state.missed)
    follow_torques(system, method, state, step.length)
    for k in range(power.size):
        state.work[k] += 0.5 * step.length * (state.power[k] + power[k]) + state.missed[k]
        state.power[k] = power[k]
    _average_losses(settings, state, step.length, taken)
    follow_trend(system, state, step.length)
    for i in range(state.position.size):
        state.position[i], state.velocity[i] = state.trial.position[i], state.trial.velocity[i]
        state.acceleration[i], state.auxiliary[i] = state.trial.acceleration[i], state.trial.auxiliary[i]
    state.clock.time = step.end


@kernel(inline=True)
def _keep(state: IntegratorState, step: Step, forces: BodyForces, steps: Steps, filled: int) -> int:
    """Keep the state that was reached and its body forces, where there is room; returns the number of steps filled."""
    if filled == steps.time.size:
        return filled
    steps.time[filled], steps.step[filled] = step.end, step.length
    for i in range(state.position.size):
        steps.position[filled, i], steps.velocity[filled, i] = state.position[i], state.velocity[i]
    for k in range(state.work.size):
        steps.work[filled, k] = state.work[k]
    keep_body_forces(forces, steps.forces, filled)
    return filled + 1

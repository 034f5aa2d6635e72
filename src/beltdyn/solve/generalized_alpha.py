"""Generalised-alpha time integration with variable steps, in compiled code.

The local error of the position is (beta + (am - af) / 2 - 1/6) h^2 (A1 - A0) to leading order.  It is
allowed in proportion to the length of the step; but not beyond a length at which errors that pull the same way would
add up to what the tension of the belt feels.
"""

from math import ceil, floor, inf, sqrt
from typing import Final

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.solve.alpha_impulse import follow_profiles
from beltdyn.solve.alpha_method import Method, method_of
from beltdyn.solve.alpha_step import Step, new_step, try_step
from beltdyn.solve.march import FAILED, REJECTED, STEPS, March, Settings, Steps, allowed_error, motion_of
from beltdyn.solve.step_bound import resolved_length
from beltdyn.system.arrays import ENERGY_WORKS, BodyForces, Motion, System
from beltdyn.system.body_forces import keep_loads
from beltdyn.system.missed_action import missed_work
from beltdyn.system.motion import Equations
from beltdyn.system.numerical_loss import numerical_loss
from beltdyn.system.state_loads import find_loads

REACHED: Final = 0
"""Status: the stop was reached, the room for steps is full, or the budget is spent."""
STEP_TOO_SMALL: Final = 1
"""Status: no step was found that converges and is accurate."""
STRETCH: Final = 1.2
"""A step may exceed the wanted one by this factor, so that it ends on an instant."""

_EASY: Final = 5
_GROWTH: Final = 2.0
_SHRINK: Final = 0.2
_AIM: Final = 0.8
_LIMIT: Final = 4.0
"""Steps are aimed at this part of the local error allowed, and taken up to this multiple: errors jump as nodes meet
pulleys, and a step tried again costs more than it gains."""
_WORST: Final = 3.0
"""A node may err by this many times the root mean square allowed of all: errors are largest at the few nodes that meet
pulleys, and would vanish in the mean of a fine mesh."""
_SMALLEST_STEP: Final = 1e-11
_NUMERICAL: Final = ENERGY_WORKS.index("numerical_loss")


@kernel
def advance(
    system: System,
    settings: Settings,
    march: March,
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
    march
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
    clock = march.clock
    for _ in range(budget):
        if clock[0] >= stop or (filled == steps.time.size and filled > 0):
            break
        length = resolved_length(system, settings, motion_of(march), _next_step(clock, settings, stop))
        step = new_step(method, clock[0], length, stop)
        iterations = try_step(system, settings, method, march, step, equations)
        if iterations == 0:
            march.counts[FAILED] += 1
            clock[1] = 0.5 / STRETCH * length
        else:
            error = _local_error(system, settings, method, march, length)
            growth = _GROWTH if iterations <= _EASY else 1.0
            factor = min(growth, max(_SHRINK, (_AIM / max(error, 1e-12)) ** (1.0 / 3.0)))
            if error > _LIMIT:
                march.counts[REJECTED] += 1
                factor /= STRETCH
            else:
                march.counts[STEPS] += 1
                _accept(system, method, march, equations, step)
                filled = _keep(march, step, equations.loads, steps, filled)
            clock[1] = min(settings.max_step, factor * length)
        if clock[1] < _SMALLEST_STEP:
            return STEP_TOO_SMALL, filled
    return REACHED, filled


@kernel(inline=True)
def _next_step(clock: FloatArray, settings: Settings, stop: float) -> float:
    """One of the equal steps to the stop, or to the last output instant that one step reaches, or else to the next."""
    wanted, interval = clock[1], settings.output_interval
    longest = min(settings.max_step, STRETCH * wanted)
    following = floor((clock[0] + 0.5 * wanted) / interval) + 1.0
    reached = floor((clock[0] + longest) / interval)
    end = max(following, reached) * interval if interval < inf else stop
    left = min(stop, end) - clock[0]
    return left / ceil(left / longest * (1.0 - 1e-6))


@kernel(inline=True)
def _local_error(system: System, settings: Settings, method: Method, march: March, step: float) -> float:
    """Local error of the positions over what is allowed: of all nodes in the mean, of the worst node, of each body."""
    auxiliary, total, worst = march.trial[3], 0.0, 0.0
    for node in range(system.nodes):
        square = 0.0
        for c in range(2 * system.points):
            i = len(system.scale) * node + c
            square += (auxiliary[i] - march.auxiliary[i]) ** 2
        total, worst = total + square, max(worst, square)
    largest = max(sqrt(total / (system.nodes * system.points)), sqrt(worst / system.points) / _WORST)
    for body in range(system.bodies.size):
        if system.bodies[body].unknown >= 0:
            i = system.first_body + body
            largest = max(largest, system.bodies[body].reach * abs(auxiliary[i] - march.auxiliary[i]))
    return method.error * step * step * largest / allowed_error(settings, step)


@kernel(inline=True)
def _accept(system: System, method: Method, march: March, equations: Equations, step: Step) -> None:
    """Move to the end of the step, and do the energy account."""
    work, corner, power = equations.work, equations.matrix.corner, equations.loads.power
    end = Motion(step.end, march.trial[0], march.trial[1], march.trial[2])
    find_loads(system, end, work, corner, equations.loads)
    march.work[_NUMERICAL] += numerical_loss(system, motion_of(march), end, march.impulse, work)
    missed_work(system, motion_of(march), end, march.impulse, march.missed)
    follow_profiles(system, method, march, step.length)
    for k in range(power.size):
        march.work[k] += 0.5 * step.length * (march.power[k] + power[k]) + march.missed[k]
        march.power[k] = power[k]
    for i in range(march.position.size):
        march.position[i], march.velocity[i] = march.trial[0, i], march.trial[1, i]
        march.acceleration[i], march.auxiliary[i] = march.trial[2, i], march.trial[3, i]
    march.clock[0] = step.end


@kernel(inline=True)
def _keep(march: March, step: Step, loads: BodyForces, steps: Steps, filled: int) -> int:
    """Keep the state that was reached and its loads, where there is room; returns the number of steps filled."""
    if filled == steps.time.size:
        return filled
    steps.time[filled], steps.step[filled] = step.end, step.length
    for i in range(march.position.size):
        steps.position[filled, i], steps.velocity[filled, i] = march.position[i], march.velocity[i]
    for k in range(march.work.size):
        steps.work[filled, k] = march.work[k]
    keep_loads(loads, steps.loads, filled)
    return filled + 1

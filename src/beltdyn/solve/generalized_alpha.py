"""Generalised-alpha time integration with variable steps, in compiled code.

Second-order form of Arnold and Brüls (2007), in which the equations of motion hold exactly at the end of each step
and an auxiliary acceleration A carries the numerical damping:

    (1 - am) A1 + am A0 = (1 - af) a1 + af a0
    q1 = q0 + h v0 + h^2 ((1/2 - beta) A0 + beta A1),    v1 = v0 + h ((1 - gamma) A0 + gamma A1)
    am = (2 rho - 1) / (rho + 1),   af = rho / (rho + 1),   gamma = 1/2 + af - am,   beta = (gamma + 1/2)^2 / 4

after Chung and Hulbert (1993).  The local error of the position is (beta + (am - af) / 2 - 1/6) h^2 (A1 - A0) to
leading order.
"""

from math import inf, isfinite, sqrt
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.kernel import kernel
from beltdyn.solve.march import FAILED, ITERATIONS, REJECTED, STEPS, March, Outputs, Settings
from beltdyn.system.arrays import NODE, System
from beltdyn.system.assembly import assemble
from beltdyn.system.excitation import prescribe
from beltdyn.system.motion import Equations, subtract_multipliers, subtract_solution
from beltdyn.system.ring_matrix import solve_ring

FloatArray = NDArray[np.float64]

REACHED: Final = 0
"""Status: the stop was reached, the buffer of outputs is full, or the budget is spent."""
STEP_TOO_SMALL: Final = 1
"""Status: no step was found that converges and is accurate."""

_MAX_ITERATIONS: Final = 10
_DAMPED_FROM: Final = 3
_EASY: Final = 5
_STAGNATION: Final = 0.5
_GROWTH: Final = 2.0
_SHRINK: Final = 0.2
_SAFETY: Final = 0.9
_SMALLEST_STEP: Final = 1e-11
_NEARLY: Final = 1.000001
"""A step may exceed the wanted one by rounding, so that it ends on an instant."""


class Method(NamedTuple):
    """Coefficients of the method for one spectral radius."""

    am: float
    af: float
    gamma: float
    beta: float
    error: float
    """Local error of the position over h^2 (A1 - A0)."""


@kernel
def method_of(rho: float) -> Method:
    """Coefficients for the spectral radius rho at infinite frequency (Chung and Hulbert 1993)."""
    am, af = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    return Method(am, af, gamma, beta, abs(beta + 0.5 * (am - af) - 1.0 / 6.0))


@kernel
def advance(
    system: System,
    settings: Settings,
    march: March,
    equations: Equations,
    stop: float,
    budget: int,
    outputs: Outputs,
) -> tuple[int, int]:
    """Integrate until a stop, until all outputs are filled, or until a number of steps has been tried.

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
    outputs
        Filled with the steps that hold the output instants.

    Returns
    -------
    status : int
        `REACHED` or `STEP_TOO_SMALL`.
    filled : int
        Number of outputs filled.
    """
    filled = 0
    method = method_of(settings.spectral_radius)
    clock = march.clock
    for _ in range(budget):
        if clock[0] >= stop or (filled == outputs.time.size and filled > 0):
            break
        step = _next_step(clock, stop, outputs, filled)
        if clock[0] + step + _SMALLEST_STEP >= outputs.horizon:
            break
        growth = _newton(system, settings, method, march, step, equations)
        if growth == 0.0:
            march.counts[FAILED] += 1
            clock[1] = 0.5 * step
        else:
            error = _local_error(system, settings, method, march, step)
            factor = min(growth, max(_SHRINK, _SAFETY / sqrt(max(error, 1e-12))))
            clock[1] = min(settings.max_step, factor * step)
            if error > 1.0:
                march.counts[REJECTED] += 1
            else:
                march.counts[STEPS] += 1
                filled = _accept(system, march, equations, step, outputs, filled)
                if abs(stop - clock[0]) < _SMALLEST_STEP:
                    clock[0] = stop
        if clock[1] < _SMALLEST_STEP:
            return STEP_TOO_SMALL, filled
    return REACHED, filled


@kernel
def _next_step(clock: FloatArray, stop: float, outputs: Outputs, filled: int) -> float:
    """The step wanted, changed by a factor of two at most so that it ends on an output instant or on the stop."""
    wanted, end = clock[1], stop
    for k in range(filled, outputs.time.size):
        if outputs.time[k] - clock[0] > 0.5 * wanted or outputs.time[k] >= stop:
            end = min(stop, outputs.time[k])
            if k + 1 == outputs.time.size or outputs.time[k + 1] - clock[0] > wanted:
                break
    left = end - clock[0]
    if left <= wanted * _NEARLY:
        return left
    return 0.5 * left if left < 2.0 * wanted else wanted


@kernel
def _newton(
    system: System, settings: Settings, method: Method, march: March, step: float, equations: Equations
) -> float:
    """Try a step: solve the equations of motion at its end.

    Returns the factor by which the next step may grow: the less, the harder the iteration; 0 if it did not converge.

    The unknown is the change of the position.  From a constant A as first guess, Newton's method runs undamped; if
    after a few iterations the change does not shrink, the iterates jump over a kink of contact or friction, and half
    steps end that.
    """
    position, velocity, acceleration, auxiliary = march.trial[0], march.trial[1], march.trial[2], march.trial[3]
    time = march.clock[0] + step
    by_velocity = method.gamma / (method.beta * step)
    by_acceleration = (1.0 - method.am) / ((1.0 - method.af) * method.beta * step * step)
    for i in range(position.size):
        a = march.auxiliary[i]
        position[i] = march.position[i] + step * march.velocity[i] + 0.5 * step * step * a
        velocity[i] = march.velocity[i] + step * a
        acceleration[i] = (a - method.af * march.acceleration[i]) / (1.0 - method.af)
    prescribe(system, time, velocity, acceleration)
    allowed = settings.newton_fraction * settings.velocity_tolerance * step
    before = inf
    for iteration in range(_MAX_ITERATIONS):
        march.counts[ITERATIONS] += 1
        assemble(
            system,
            time,
            position,
            velocity,
            acceleration,
            march.multipliers,
            1.0,
            by_velocity,
            by_acceleration,
            equations.work,
            equations.matrix,
            equations.loads,
        )
        solved = solve_ring(equations.matrix, system.closed, equations.node_part, equations.border_part)
        change = _size_of_step(system, settings, equations)
        if not solved or not isfinite(change):
            return 0.0
        factor = 0.5 if iteration >= _DAMPED_FROM and change > _STAGNATION * before else 1.0
        subtract_solution(system, equations, factor, position)
        subtract_solution(system, equations, factor * by_velocity, velocity)
        subtract_solution(system, equations, factor * by_acceleration, acceleration)
        subtract_multipliers(system, equations, factor, march.multipliers)
        if change <= allowed:
            for i in range(position.size):
                auxiliary[i] = (
                    (1.0 - method.af) * acceleration[i]
                    + method.af * march.acceleration[i]
                    - method.am * march.auxiliary[i]
                ) / (1.0 - method.am)
            return _GROWTH if iteration < _EASY else 1.0
        before = change
    return 0.0


@kernel
def _size_of_step(system: System, settings: Settings, equations: Equations) -> float:
    """Root mean square of the change of the nodes, or the largest change at a pulley's rim, m."""
    total = 0.0
    for node in range(system.nodes):
        for c in range(NODE):
            total += (settings.length_scale[c] * equations.node_part[node, c]) ** 2
    size = sqrt(total / (NODE * system.nodes))
    for p in range(system.pulleys.radius.size):
        unknown = system.pulleys.unknown[p]
        if unknown >= 0:
            size = max(size, abs(system.pulleys.radius[p] * equations.border_part[unknown]))
    return size


@kernel
def _local_error(system: System, settings: Settings, method: Method, march: March, step: float) -> float:
    """Local error of the positions over what is allowed: of nodes in the root mean square, of each pulley's rim."""
    auxiliary, total = march.trial[3], 0.0
    for node in range(system.nodes):
        for c in range(2 * system.points):
            i = NODE * node + c
            total += (auxiliary[i] - march.auxiliary[i]) ** 2
    largest = sqrt(total / (system.nodes * system.points))
    for p in range(system.pulleys.radius.size):
        if system.pulleys.unknown[p] >= 0:
            i = NODE * system.nodes + p
            largest = max(largest, system.pulleys.radius[p] * abs(auxiliary[i] - march.auxiliary[i]))
    return method.error * step * largest / settings.velocity_tolerance


@kernel
def _accept(system: System, march: March, equations: Equations, step: float, outputs: Outputs, filled: int) -> int:
    """Keep the step where it holds output instants, and move to its end; returns the number of outputs filled."""
    start = march.clock[0]
    position, velocity, power = march.trial[0], march.trial[1], equations.loads.power
    for p in range(system.pulleys.radius.size):
        if system.pulleys.unknown[p] < 0:
            i = NODE * system.nodes + p
            position[i] = march.position[i] + 0.5 * step * (march.velocity[i] + velocity[i])
    while filled < outputs.time.size and outputs.time[filled] <= start + step + _SMALLEST_STEP:
        x = min(1.0, (outputs.time[filled] - start) / step)
        outputs.fraction[filled] = x
        outputs.step[filled] = step
        for i in range(position.size):
            outputs.position[filled, 0, i], outputs.position[filled, 1, i] = march.position[i], position[i]
            outputs.velocity[filled, 0, i], outputs.velocity[filled, 1, i] = march.velocity[i], velocity[i]
        for k in range(power.size):
            gain = (1.0 - 0.5 * x) * march.power[k] + 0.5 * x * power[k]
            outputs.work[filled, k] = march.work[k] + x * step * gain
        filled += 1
    for k in range(power.size):
        march.work[k] += 0.5 * step * (march.power[k] + power[k])
        march.power[k] = power[k]
    for i in range(position.size):
        march.position[i], march.velocity[i] = position[i], velocity[i]
        march.acceleration[i], march.auxiliary[i] = march.trial[2, i], march.trial[3, i]
    march.clock[0] = start + step
    return filled

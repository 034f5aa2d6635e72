"""Generalised-alpha time integration with variable steps, in compiled code.

Second-order form of Arnold and Brüls (2007), in which the equations of motion hold exactly at the end of each step and an auxiliary
acceleration A carries the numerical damping:

    (1 - am) A1 + am A0 = (1 - af) a1 + af a0
    q1 = q0 + h v0 + h^2 ((1/2 - beta) A0 + beta A1),    v1 = v0 + h ((1 - gamma) A0 + gamma A1)
    am = (2 rho - 1) / (rho + 1),   af = rho / (rho + 1),   gamma = 1/2 + af - am,   beta = (gamma + 1/2)^2 / 4

after Chung and Hulbert (1993).  The local error of the position is (beta + (am - af) / 2 - 1/6) h^2 (A1 - A0) to leading order.
"""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import ConvergenceError
from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, POWERS, System
from beltdyn.system.assembly import assemble
from beltdyn.system.excitation import prescribe, prescribe_speeds
from beltdyn.system.motion import Equations, accelerate, subtract_multipliers, subtract_solution
from beltdyn.system.ring_matrix import solve_ring

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

REACHED: Final = 0
"""Status: the stop was reached, the buffer of outputs is full, or the budget is spent."""
STEP_TOO_SMALL: Final = 1
"""Status: no step was found that converges and is accurate."""

STEPS: Final = 0
REJECTED: Final = 1
FAILED: Final = 2
ITERATIONS: Final = 3

_MAX_ITERATIONS: Final = 10
_DAMPED_FROM: Final = 3
_STAGNATION: Final = 0.5
_GROWTH: Final = 2.0
_SHRINK: Final = 0.2
_SAFETY: Final = 0.9
_SMALLEST_STEP: Final = 1e-11


class Settings(NamedTuple):
    """Choices of the user, as numbers."""

    spectral_radius: float
    """rho at infinite frequency, 0 (strongest damping) to 1 (none)."""
    velocity_tolerance: float
    """Local error allowed per unit of time, m/s: the relative tolerance times a velocity of the drive."""
    newton_fraction: float
    """Newton stops when its error is below this fraction of the local error allowed."""
    max_step: float
    """s."""
    length_scale: FloatArray
    """Lengths that turn changes of r, r_x, r_y into m, shape (6,)."""


class March(NamedTuple):
    """The moving state of an integration, and what it tries next; everything is changed in place."""

    clock: FloatArray
    """Time and next step, s, shape (2,)."""
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    auxiliary: FloatArray
    """A of the method."""
    multipliers: FloatArray
    work: FloatArray
    """Time integrals of the powers in the loads, J, shape (4,)."""
    power: FloatArray
    """These powers at the present time, W, shape (4,)."""
    trial: FloatArray
    """Position, velocity, acceleration and A at the end of the step that is tried, shape (4, 6 N + P)."""
    counts: IntArray
    """Steps, steps rejected for their error, steps that Newton failed, Newton iterations; shape (4,)."""


class Outputs(NamedTuple):
    """States at the output instants, filled by `advance`."""

    time: FloatArray
    """Instants, s, ascending, shape (k,)."""
    position: FloatArray
    """Shape (k, 6 N + P)."""
    velocity: FloatArray
    work: FloatArray
    """Shape (k, 4)."""
    step: FloatArray
    """Step that the solver took around each instant, s, shape (k,)."""


class Method(NamedTuple):
    """Coefficients of the method for one spectral radius."""

    am: float
    af: float
    gamma: float
    beta: float
    error: float
    """Local error of the position over h^2 (A1 - A0)."""


def new_march(time: float, step: float, position: FloatArray, velocity: FloatArray) -> March:
    """Begin an integration.

    Parameters
    ----------
    time, step
        Where to begin, and the first step to try, s.
    position, velocity : ndarray, shape (6 N + P,)
        State to begin from; copied.

    Returns
    -------
    March
        `restart` has to give it accelerations before it can `advance`.
    """
    size = position.size
    return March(
        clock=np.array((time, step)),
        position=position.copy(),
        velocity=velocity.copy(),
        acceleration=np.zeros(size),
        auxiliary=np.zeros(size),
        multipliers=np.zeros(NODE),
        work=np.zeros(len(POWERS)),
        power=np.zeros(len(POWERS)),
        trial=np.zeros((4, size)),
        counts=np.zeros(4, dtype=np.int64),
    )


def restart(system: System, march: March, equations: Equations) -> None:
    """Take the accelerations from the equations of motion: at the start, and after a jump of what drives the system.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    march
        Changed in place; profiles are taken just after its time.
    equations
        Arrays to work in.

    Raises
    ------
    ConvergenceError
        If the mass matrix is singular.
    """
    after = float(np.nextafter(march.clock[0], np.inf))
    if not accelerate(
        system, after, march.position, march.velocity, march.acceleration, march.multipliers, equations
    ):
        raise ConvergenceError("the mass matrix is singular: a node or a pulley has no mass. Give it some.")
    march.auxiliary[:] = march.acceleration
    march.power[:] = equations.loads.power


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
        Filled by cubic Hermite interpolation within steps.

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
        left = stop - clock[0]
        step = left if clock[1] >= left else min(clock[1], 0.5 * left) if 2.0 * clock[1] > left else clock[1]
        if not _newton(system, settings, method, march, step, equations):
            march.counts[FAILED] += 1
            clock[1] = 0.5 * step
        else:
            error = _local_error(system, settings, method, march, step)
            factor = min(_GROWTH, max(_SHRINK, _SAFETY / np.sqrt(max(error, 1e-12))))
            if error > 1.0:
                march.counts[REJECTED] += 1
                clock[1] = factor * step
            else:
                end = stop if step == left else clock[0] + step
                filled = _accept(system, march, equations, end, outputs, filled)
                march.counts[STEPS] += 1
                if factor < 1.0 or step >= 0.5 * clock[1]:
                    clock[1] = min(settings.max_step, factor * step)
        if clock[1] < _SMALLEST_STEP:
            return STEP_TOO_SMALL, filled
    return REACHED, filled


@kernel
def _newton(
    system: System, settings: Settings, method: Method, march: March, step: float, equations: Equations
) -> bool:
    """Try a step: solve the equations of motion at its end; False if the iteration does not converge.

    The unknown is the change of the position.  From a constant A as first guess, Newton's method runs undamped; if after a few
    iterations the change does not shrink, the iterates jump over a kink of contact or friction, and half steps end that.
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
    before = np.inf
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
        if not solved or not np.isfinite(change):
            return False
        factor = 0.5 if iteration >= _DAMPED_FROM and change > _STAGNATION * before else 1.0
        subtract_solution(system, equations, factor, position)
        subtract_solution(system, equations, factor * by_velocity, velocity)
        subtract_solution(system, equations, factor * by_acceleration, acceleration)
        subtract_multipliers(system, equations, factor, march.multipliers)
        if change <= allowed:
            for i in range(position.size):
                auxiliary[i] = (
                    (1.0 - method.af) * acceleration[i] + method.af * march.acceleration[i] - method.am * march.auxiliary[i]
                ) / (1.0 - method.am)
            return True
        before = change
    return False


@kernel
def _size_of_step(system: System, settings: Settings, equations: Equations) -> float:
    """Root mean square of the change of the nodes, or the largest change at a pulley's rim, m."""
    total = 0.0
    for node in range(system.nodes):
        for c in range(NODE):
            total += (settings.length_scale[c] * equations.node_part[node, c]) ** 2
    size = np.sqrt(total / (NODE * system.nodes))
    for p in range(system.pulleys.radius.size):
        unknown = system.pulleys.unknown[p]
        if unknown >= 0:
            size = max(size, abs(system.pulleys.radius[p] * equations.border_part[unknown]))
    return size


@kernel
def _local_error(system: System, settings: Settings, method: Method, march: March, step: float) -> float:
    """Local error of the positions over what is allowed: of the nodes in the root mean square, of the rims of pulleys each."""
    auxiliary, total = march.trial[3], 0.0
    for node in range(system.nodes):
        for c in range(2):
            i = NODE * node + c
            total += (auxiliary[i] - march.auxiliary[i]) ** 2
    largest = np.sqrt(total / system.nodes)
    for p in range(system.pulleys.radius.size):
        if system.pulleys.unknown[p] >= 0:
            i = NODE * system.nodes + p
            largest = max(largest, system.pulleys.radius[p] * abs(auxiliary[i] - march.auxiliary[i]))
    return method.error * step * largest / settings.velocity_tolerance


@kernel
def _accept(
    system: System, march: March, equations: Equations, end: float, outputs: Outputs, filled: int
) -> int:
    """Write the outputs that lie in the step and move the march to its end; returns the number of outputs filled."""
    start = march.clock[0]
    step = end - start
    position, velocity, power = march.trial[0], march.trial[1], equations.loads.power
    for p in range(system.pulleys.radius.size):
        if system.pulleys.unknown[p] < 0:
            i = NODE * system.nodes + p
            position[i] = march.position[i] + 0.5 * step * (march.velocity[i] + velocity[i])
    while filled < outputs.time.size and outputs.time[filled] <= end:
        x = (outputs.time[filled] - start) / step
        _interpolate(march.position, march.velocity, position, velocity, x, step, outputs, filled)
        for k in range(march.power.size):
            outputs.work[filled, k] = march.work[k] + x * step * (
                (1.0 - 0.5 * x) * march.power[k] + 0.5 * x * power[k]
            )
        outputs.step[filled] = step
        prescribe_speeds(system, outputs.time[filled], outputs.velocity[filled])
        filled += 1
    for k in range(march.power.size):
        march.work[k] += 0.5 * step * (march.power[k] + power[k])
        march.power[k] = power[k]
    march.position[:] = position
    march.velocity[:] = velocity
    march.acceleration[:] = march.trial[2]
    march.auxiliary[:] = march.trial[3]
    march.clock[0] = end
    return filled


@kernel
def _interpolate(
    position_0: FloatArray,
    velocity_0: FloatArray,
    position_1: FloatArray,
    velocity_1: FloatArray,
    x: float,
    step: float,
    outputs: Outputs,
    row: int,
) -> None:
    """Cubic Hermite interpolation of the position at the fraction x of a step, and its derivative."""
    rest = 1.0 - x
    for i in range(position_0.size):
        rise = (position_1[i] - position_0[i]) / step
        outputs.position[row, i] = (
            position_0[i]
            + x * x * (3.0 - 2.0 * x) * step * rise
            + step * x * rest * (rest * velocity_0[i] - x * velocity_1[i])
        )
        outputs.velocity[row, i] = (
            6.0 * x * rest * rise + rest * (1.0 - 3.0 * x) * velocity_0[i] + x * (3.0 * x - 2.0) * velocity_1[i]
        )

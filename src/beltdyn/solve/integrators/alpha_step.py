"""One step of generalised-alpha, solved by Newton's method with a line search, in compiled code.

Second-order form of Arnold and Brüls (2007), in which the equations of motion hold exactly at the end of each step
and an auxiliary acceleration A carries the numerical damping:

    (1 - am) A1 + am A0 = (1 - af) a1 + af a0
    q1 = q0 + h v0 + h^2 ((1/2 - beta) A0 + beta A1),    v1 = v0 + h ((1 - gamma) A0 + gamma A1)
    am = (2 rho - 1) / (rho + 1),   af = rho / (rho + 1),   gamma = 1/2 + af - am,   beta = (gamma + 1/2)^2 / 4

after Chung and Hulbert (1993).
"""

from math import inf, isfinite, sqrt
from typing import Final, NamedTuple

from beltdyn.kernel import kernel
from beltdyn.solve.integrators.alpha_method import Method
from beltdyn.solve.integrators.alpha_predictor import predict
from beltdyn.solve.integrators.integrator_state import IntegratorState, Settings, allowed_error, trial_motion
from beltdyn.system.arrays import NO_TANGENT, Equations, System, TangentFactors
from beltdyn.system.assembly import assemble
from beltdyn.system.motion import subtract_multipliers, subtract_solution
from beltdyn.system.ring_matrix import factorise_ring, substitute

_MAX_ITERATIONS: Final = 16
_OVERSHOOT: Final = 0.1
"""Imbalance along a change, over that before it and against it, from which on a part of the change is taken back."""
_CUTS: Final = 6
_SHORTEST: Final = 0.1
"""Least part of where the balance may be by which it is looked for."""
_GROWING: Final = 4
"""So many changes with no less imbalance along them than the one before, and the step is given up."""
_QUICK: Final = 0.3
"""A tangent serves for several iterations of a step as long as each change is below this part of the one before."""
_SAME: Final = 1e-11
"""Instants nearer to each other than this are one, s."""
_NEAR: Final = 3.0
"""The body forces are those before the last change, which must be below this many times what Newton's method may
leave."""


class Step(NamedTuple):
    """A step that is tried."""

    end: float
    """s."""
    length: float
    """s."""
    factors: TangentFactors
    """Changes of position, velocity and acceleration over that of the unknown, which is the position."""


@kernel
def new_step(method: Method, start: float, length: float, stop: float) -> Step:
    """A step to be tried.

    Parameters
    ----------
    method
        Coefficients.
    start
        Where it begins, s.
    length
        Its length, s.
    stop
        Instant on which it ends if rounding alone lies between, s.
    """
    return Step(
        stop if abs(stop - start - length) < _SAME else start + length,
        length,
        TangentFactors(
            1.0,
            method.gamma / (method.beta * length),
            (1.0 - method.am) / ((1.0 - method.af) * method.beta * length * length),
            False,
        ),
    )


@kernel
def try_step(
    system: System, settings: Settings, method: Method, state: IntegratorState, step: Step, equations: Equations
) -> int:
    """Solve the equations of motion at the end of a step, from the first guess of `alpha_predictor`.

    The unknown is the change of the position.  Where a change jumps over a kink of contact or friction, the residual
    along it turns against it; then only the part up to the balance is kept: forces of friction and contact resist
    motion the more the faster it is, so that this part brings the solution nearer, where longer ones may go around it.
    The tangent of the first guess serves as long as changes shrink quickly, where they did so in the step before too.
    Where they did not, the first change takes friction by its secant: where the first guess slides and the solution
    sticks, the slope would let the belt go.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    settings
        Tolerances.
    method
        Coefficients.
    state
        Its trial state is overwritten.
    step
        From `new_step`.
    equations
        Arrays to work in; afterwards its body forces are those of the last iterate but one.

    Returns
    -------
    int
        Iterations, or 0 if they did not converge.
    """
    predict(system, method, state, step.length, step.end)
    allowed = settings.newton_fraction * allowed_error(settings, step.length)
    before, slope, steepest, renewed = inf, 0.0, inf, True
    quick, slowest, growing = state.clock.contraction <= _QUICK, 0.0, 0
    state.clock.contraction = 1.0
    for iteration in range(_MAX_ITERATIONS):
        state.counts.iterations += 1
        _assemble(system, state, step, equations, renewed, iteration == 0 and not quick)
        factor = _cut_back(system, state, step, equations, slope, renewed) if slope > 0.0 else 1.0
        if renewed and not factorise_ring(equations.matrix, system.closed):
            return 0
        substitute(equations.matrix, system.closed, equations.node_part, equations.border_part)
        change = _size(system, equations)
        if not isfinite(change):
            return 0
        slope = _imbalance(equations)
        slowest = max(slowest, change / before)
        contraction = min(1.0, change / before) if factor == 1.0 else 1.0
        _move(system, state, step, equations, 1.0)
        if change <= _NEAR * allowed and contraction * change <= allowed:
            _finish(method, state)
            state.clock.contraction = slowest
            return iteration + 1
        growing += abs(slope) >= steepest
        steepest = min(abs(slope), steepest)
        if growing >= _GROWING:
            return 0
        renewed = not quick or slowest > _QUICK
        before = change
    return 0


@kernel(inline=True)
def _assemble(
    system: System, state: IntegratorState, step: Step, equations: Equations, renewed: bool, secant: bool
) -> None:
    """Assemble the residual at the trial state, and the tangent if it is renewed."""
    by = step.factors
    factors = TangentFactors(by.by_position, by.by_velocity, by.by_acceleration, secant) if renewed else NO_TANGENT
    assemble(system, trial_motion(state, step.end), state.multipliers, factors, equations)


@kernel(inline=True)
def _cut_back(
    system: System, state: IntegratorState, step: Step, equations: Equations, slope: float, renewed: bool
) -> float:
    """Take back what the last change went too far, up to the balance along it; returns the factor of what is left.

    It is found by the false position (Illinois).
    """
    now = _imbalance(equations)
    if now >= -_OVERSHOOT * slope:
        return 1.0
    factor, short, ahead, far, behind, beyond = 1.0, 0.0, slope, 1.0, now, True
    for _ in range(_CUTS):
        place = short + (far - short) * max(_SHORTEST, ahead / (ahead - behind))
        _move(system, state, step, equations, place - factor)
        factor = place
        _assemble(system, state, step, equations, False, False)
        now = _imbalance(equations)
        if abs(now) <= _OVERSHOOT * slope:
            break
        if now < 0.0:
            far, behind, ahead = factor, now, 0.5 * ahead if beyond else ahead
        else:
            short, ahead, behind = factor, now, behind if beyond else 0.5 * behind
        beyond = now < 0.0
    if renewed:
        _assemble(system, state, step, equations, True, False)
    return factor


@kernel(inline=True)
def _move(system: System, state: IntegratorState, step: Step, equations: Equations, factor: float) -> None:
    """Take factor times the solution off the trial state."""
    subtract_solution(system, equations, factor, state.trial.position)
    subtract_solution(system, equations, factor * step.factors.by_velocity, state.trial.velocity)
    subtract_solution(system, equations, factor * step.factors.by_acceleration, state.trial.acceleration)
    subtract_multipliers(system, equations, factor, state.multipliers)


@kernel(inline=True)
def _finish(method: Method, state: IntegratorState) -> None:
    """A at the end of the step, from the accelerations."""
    for i in range(state.position.size):
        state.trial.auxiliary[i] = (
            (1.0 - method.af) * state.trial.acceleration[i]
            + method.af * state.acceleration[i]
            - method.am * state.auxiliary[i]
        ) / (1.0 - method.am)


@kernel(inline=True)
def _imbalance(equations: Equations) -> float:
    """Residual along the last solution, J."""
    matrix, total = equations.matrix, 0.0
    for node in range(matrix.node_side.shape[0]):
        for c in range(len(matrix.unknowns)):
            total += matrix.node_side[node, c] * equations.node_part[node, c]
    for i in range(matrix.border_side.size):
        total += matrix.border_side[i] * equations.border_part[i]
    return total


@kernel(inline=True)
def _size(system: System, equations: Equations) -> float:
    """Root mean square of the change of the nodes, or the largest change of a body, m."""
    total = 0.0
    for node in range(system.nodes):
        for c in range(len(system.scale)):
            total += (system.scale[c] * equations.node_part[node, c]) ** 2
    size = sqrt(total / system.first_body)
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            size = max(size, abs(system.bodies[body].reach * equations.border_part[unknown]))
    return size

"""One step of generalized-alpha, solved by Newton's method with a line search, in compiled code.

Second-order form of Arnold and Brüls (2007), in which the equations of motion hold exactly at the end of each step
and an auxiliary acceleration A carries the numerical damping:

    (1 - am) A1 + am A0 = (1 - af) a1 + af a0
    q1 = q0 + h v0 + h^2 ((1/2 - beta) A0 + beta A1),    v1 = v0 + h ((1 - gamma) A0 + gamma A1)
    am = (2 rho - 1) / (rho + 1),   af = rho / (rho + 1),   gamma = 1/2 + af - am,   beta = (gamma + 1/2)^2 / 4

after Chung and Hulbert (1993).
"""

from math import inf, isfinite, isnan, sqrt
from typing import Any, Final, NamedTuple

from beltdyn.kernel import by_type, kernel
from beltdyn.machines.links import torque_of_kind
from beltdyn.machines.loads.shaft import load_torque
from beltdyn.machines.profiles.functions import NO_SCHEDULE, after_jump, profile_value, schedule_value
from beltdyn.solvers.integrator_state import (
    IntegratorState,
    Settings,
    allowed_error,
    motion_of,
    trial_motion,
)
from beltdyn.system.arrays import (
    NO_TANGENT,
    Equations,
    System,
    TangentFactors,
)
from beltdyn.system.body_forces import prescribe
from beltdyn.system.frame import Flowing, FlowingByArcs, Travelling
from beltdyn.system.missed_action import extrapolated_load, missed_impulses
from beltdyn.system.ring_matrix import factorise_ring, substitute
from beltdyn.system.steady_assembly import assemble, subtract_multipliers, subtract_solution

# Coefficients of generalized-alpha (Chung and Hulbert 1993); the method is described in `alpha_step`


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


# The impulses of what is prescribed over time, exact whatever the step


@kernel
def add_missed_impulses(system: System, method: Method, state: IntegratorState, length: float) -> None:
    """Let the impulses that a step misses act on the free bodies of the trial state, evenly over the step.

    `method`: coefficients; `state`: its trial position and velocity are changed, and its impulses overwritten;
    `length`: length of the step, s.
    """
    missed_impulses(system, motion_of(state), length, state.impulse)
    first = system.first_body
    for k in range(2):
        for body in range(system.bodies.size):
            _push(system, state, body, state.impulse[k, first + body], length)
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown >= 0:
            _push(system, state, body, _lag_of_shaft(system, method, state, p, length), length)
    for number in range(system.links.size):
        link = system.links[number]
        if link.schedule != NO_SCHEDULE:
            twist = state.position[first + link.front] - state.position[first + link.back]
            rate = state.velocity[first + link.front] - state.velocity[first + link.back]
            full = torque_of_kind(link, 1.0, twist, rate)  # what may stick in full does not feel its schedule
            impulse = full.by_schedule * lag_of(system, method, state, link.schedule, length)
            _push(system, state, link.front, -impulse, length)
            _push(system, state, link.back, impulse, length)


@kernel
def follow_torques(system: System, method: Method, state: IntegratorState, length: float) -> None:
    """Bring what the method makes of the profiles, and of loads over the angle, to the end of a step.

    `method`: coefficients; `state`: at the beginning of the step, with its end on trial; `lagged` is changed; `length`:
    length of the step, s.
    """
    start, end = motion_of(state), trial_motion(state, state.clock.time + length)
    profiles = system.profiles.table.size - 1
    for number in range(profiles):
        before, after = _profile_at_ends(system, state, number, length)
        state.lagged[number] = _follow(method, before, after, state.lagged[number])[1]
    for p in range(system.pulleys.size):
        for load in range(system.shaft_loads.first[p], system.shaft_loads.first[p + 1]):
            if system.shaft_loads.table[load].order > 0.0:
                before = extrapolated_load(system, p, load, start, after_jump(start.time))
                after = extrapolated_load(system, p, load, end, end.time)
                state.lagged[profiles + load] = _follow(method, before, after, state.lagged[profiles + load])[1]


@kernel(inline=True)
def _push(system: System, state: IntegratorState, body: int, impulse: float, length: float) -> None:
    """Change the trial state of a free body by an angular impulse that acts evenly over the step."""
    if impulse != 0.0 and system.bodies[body].unknown >= 0:
        i, gain = system.first_body + body, impulse / system.bodies[body].inertia
        state.trial.position[i] += 0.5 * length * gain
        state.trial.velocity[i] += gain


@kernel(inline=True)
def _lag_of_shaft(system: System, method: Method, state: IntegratorState, pulley: int, length: float) -> float:
    """What the method leaves of the impulses of a shaft's torque and loads, N m s."""
    loads = system.shaft_loads
    impulse = lag_of(system, method, state, pulley, length)
    for load in range(loads.first[pulley], loads.first[pulley + 1]):
        if loads.table[load].order > 0.0:
            impulse += _lag_over_angle(system, method, state, pulley, load, length)
        else:
            impulse += _lag_over_time(system, method, state, pulley, load, length)
    return impulse


@kernel(inline=True)
def _lag_over_angle(
    system: System, method: Method, state: IntegratorState, pulley: int, load: int, length: float
) -> float:
    """The same of a load over the angle, with the motion of the shaft extrapolated over the step."""
    motion = motion_of(state)
    before = extrapolated_load(system, pulley, load, motion, after_jump(motion.time))
    after = extrapolated_load(system, pulley, load, motion, motion.time + length)
    return _lag(method, before, after, state.lagged[system.profiles.table.size - 1 + load], length)


@kernel(inline=True)
def _lag_over_time(
    system: System, method: Method, state: IntegratorState, pulley: int, load: int, length: float
) -> float:
    """The same of the schedule and the command of a load."""
    loads, impulse = system.shaft_loads, 0.0
    i = system.first_body + system.pulleys[pulley].shaft
    schedule, command = loads.table[load].schedule, loads.table[load].command
    if schedule != NO_SCHEDULE or command != NO_SCHEDULE:
        time = after_jump(state.clock.time)
        states = state.position[system.first_body :]
        full = load_torque(system.profiles, loads, load, time, state.position[i], state.velocity[i], states)
        if schedule != NO_SCHEDULE:
            impulse += full.torque * lag_of(system, method, state, schedule, length)
        if command != NO_SCHEDULE:
            scale = schedule_value(system.profiles, schedule, time)
            impulse += scale * full.by_command * lag_of(system, method, state, command, length)
    return impulse


@kernel
def lag_of(system: System, method: Method, state: IntegratorState, number: int, length: float) -> float:
    """Integral of the straight line between the ends of a profile over a step, less what the method makes of it."""
    before, after = _profile_at_ends(system, state, number, length)
    return _lag(method, before, after, state.lagged[number], length)


@kernel(inline=True)
def _profile_at_ends(system: System, state: IntegratorState, number: int, length: float) -> tuple[float, float]:
    """Values of a profile at the ends of a step."""
    before = profile_value(system.profiles, number, after_jump(state.clock.time))[0]
    return before, profile_value(system.profiles, number, state.clock.time + length)[0]


@kernel(inline=True)
def _lag(method: Method, before: float, after: float, lagged: float, length: float) -> float:
    """Integral of the straight line between two values over a step, less what the method makes of them."""
    followed, follows = _follow(method, before, after, lagged)
    return length * (0.5 * (before + after) - (1.0 - method.gamma) * followed - method.gamma * follows)


@kernel(inline=True)
def _follow(method: Method, before: float, after: float, lagged: float) -> tuple[float, float]:
    """What the method makes of the values at the ends of a step, from that at its beginning, nan after a jump."""
    followed = before if isnan(lagged) else lagged
    return followed, ((1.0 - method.af) * after + method.af * before - method.am * followed) / (1.0 - method.am)


# The first guess of a step of generalized-alpha


@kernel
def predict(system: System, method: Method, state: IntegratorState, length: float, end: float) -> None:
    """Overwrite the trial state by the first guess of a step.

    `method`: coefficients; `state`: at the beginning of the step; its trial state is overwritten; `length`, `end`:
    length of the step and where it ends, s.
    """
    expected = state.clock.persistence * length
    for i in range(state.position.size):
        before, after = state.auxiliary[i], state.auxiliary[i] + expected * state.trend[i]
        bend = (0.5 - method.beta) * before + method.beta * after
        rise = (1.0 - method.gamma) * before + method.gamma * after
        state.trial.position[i] = state.position[i] + length * state.velocity[i] + length * length * bend
        state.trial.velocity[i] = state.velocity[i] + length * rise
        state.trial.acceleration[i] = (
            (1.0 - method.am) * after + method.am * before - method.af * state.acceleration[i]
        ) / (1.0 - method.af)
    add_missed_impulses(system, method, state, length)
    prescribe(system, trial_motion(state, end))


@kernel
def follow_trend(system: System, state: IntegratorState, length: float) -> None:
    """Take the change of A over a step, and how much of it the change before foretold.

    `state`: at the beginning of the step, with its end on trial; trend and persistence are changed; `length`: length of
    the step, s.
    """
    state.clock.persistence = _persistence(system.frame, system, state, length)
    for i in range(state.auxiliary.size):
        state.trend[i] = (state.trial.auxiliary[i] - state.auxiliary[i]) / length


@kernel(inline=True)
def _none(frame: Travelling, system: System, state: IntegratorState, length: float) -> float:
    """Of nodes that travel with the belt."""
    return 0.0


@kernel(inline=True)
def _of_bodies(frame: Any, system: System, state: IntegratorState, length: float) -> float:
    """The part of the change before that fits the change over this step best: of the belt's flow, shafts, tensioners.

    Their speeds decide on slip; accelerations of nodes tremble beside them.
    """
    along = square = 0.0
    for body in range(system.bodies.size):
        i, reach = system.first_body + body, system.bodies[body].reach
        before = reach * length * state.trend[i]
        along += before * reach * (state.trial.auxiliary[i] - state.auxiliary[i])
        square += before * before
    return min(1.0, max(0.0, along / square)) if square > 0.0 else 0.0


_persistence = by_type({Travelling: _none, Flowing: _of_bodies, FlowingByArcs: _of_bodies}, "persistence")


_MAX_ITERATIONS: Final = 16
"""Newton iterations of a step; beyond, it is rejected and tried again with less than half its length."""
_OVERSHOOT: Final = 0.1
"""Imbalance along a change, over that before it and against it, from which on a part of the change is taken back."""
_MAX_CUTS: Final = 6
"""Steps of the false position for the balance along a change; beyond, the last part is kept, and the next iteration
corrects it."""
_SHORTEST: Final = 0.1
"""Smallest step of the search for the balance, over its interval."""
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

    `method`: coefficients; `start`: where it begins, s; `length`: its length, s; `stop`: instant on which it ends if
    rounding alone lies between, s.
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
    """Solve the equations of motion at the end of a step, from the first guess of `predict`.

    The unknown is the change of the position.  Where a change jumps over a kink of contact or friction, the residual
    along it turns against it; then only the part up to the balance is kept: forces of friction and contact resist
    motion the more the faster it is, so that this part brings the solution nearer, where longer ones may go around it.
    The tangent of the first guess serves as long as changes shrink quickly, where they did so in the step before too.
    Where they did not, the first change takes friction by its secant: where the first guess slides and the solution
    sticks, the slope would let the belt go.

    `system`: belt, pulleys, supports; `settings`: tolerances; `method`: coefficients; `state`: its trial state is
    overwritten; `step`: from `new_step`; `equations`: arrays to work in; afterwards its body forces are those of the
    last iterate but one. Returns iterations, or 0 if they did not converge.
    """
    predict(system, method, state, step.length, step.end)
    allowed = max(settings.newton_fraction * allowed_error(settings, step.length), settings.rounding)
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
    for _ in range(_MAX_CUTS):
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

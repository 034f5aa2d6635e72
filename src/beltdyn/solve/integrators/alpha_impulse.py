"""The impulses of what is prescribed over time, exact whatever the step.

The equations of motion hold at the ends of a step and know the torques there only.  Generalised-alpha makes of the
values x of a torque or a schedule the impulse h ((1 - gamma) X0 + gamma X1), where X follows x as A follows the
acceleration; the rest of the integral of x is added here.  Torques over the angle of the shaft are taken for
prescribed over a step, in which the shaft moves on with its acceleration at the beginning.
"""

from math import isnan

from beltdyn.kernel import kernel
from beltdyn.machines.links.registry import torque_of_kind
from beltdyn.machines.loads.shaft import load_torque
from beltdyn.machines.profiles.functions import NO_SCHEDULE, after_jump, profile_value, schedule_value
from beltdyn.solve.integrators.alpha_method import Method
from beltdyn.solve.integrators.integrator_state import IntegratorState, motion_of, trial_motion
from beltdyn.system.arrays import System
from beltdyn.system.missed_action import extrapolated_load, missed_impulses


@kernel
def add_missed_impulses(system: System, method: Method, state: IntegratorState, length: float) -> None:
    """Let the impulses that a step misses act on the free bodies of the trial state, evenly over the step.

    Parameters
    ----------
    system
        The system.
    method
        Coefficients.
    state
        Its trial position and velocity are changed, and its impulses overwritten.
    length
        Length of the step, s.
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

    Parameters
    ----------
    system
        The system.
    method
        Coefficients.
    state
        At the beginning of the step, with its end on trial; `lagged` is changed.
    length
        Length of the step, s.
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

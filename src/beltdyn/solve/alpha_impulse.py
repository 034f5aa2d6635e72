"""The impulses of what is prescribed over time, exact whatever the step.

The equations of motion hold at the ends of a step and know the torques there only.  Generalised-alpha makes of the
values x of a torque or a schedule the impulse h ((1 - gamma) X0 + gamma X1), where X follows x as A follows the
acceleration; the rest of the integral of x is added here.
"""

from math import isnan

from beltdyn.kernel import kernel
from beltdyn.machines.links.registry import torque_of_kind
from beltdyn.machines.loads.shaft import load_torque
from beltdyn.machines.profiles.functions import NO_SCHEDULE, after_jump, profile_value, schedule_value
from beltdyn.solve.alpha_method import Method
from beltdyn.solve.integrator_state import IntegratorState, motion_of
from beltdyn.system.arrays import System
from beltdyn.system.missed_action import missed_impulses


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
def follow_profiles(system: System, method: Method, state: IntegratorState, length: float) -> None:
    """Bring what the method makes of the profiles to the end of a step.

    Parameters
    ----------
    system
        The system.
    method
        Coefficients.
    state
        At the beginning of the step; `lagged` is changed.
    length
        Length of the step, s.
    """
    for number in range(state.lagged.size):
        state.lagged[number] = _follow(system, method, state, number, length)[3]


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
    i = system.first_body + system.pulleys[pulley].shaft
    impulse = lag_of(system, method, state, pulley, length)
    for load in range(loads.first[pulley], loads.first[pulley + 1]):
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
    before, after, followed, follows = _follow(system, method, state, number, length)
    return length * (0.5 * (before + after) - (1.0 - method.gamma) * followed - method.gamma * follows)


@kernel(inline=True)
def _follow(
    system: System, method: Method, state: IntegratorState, number: int, length: float
) -> tuple[float, float, float, float]:
    """Values of a profile at the ends of a step, and what the method makes of them."""
    before = profile_value(system.profiles, number, after_jump(state.clock.time))[0]
    after = profile_value(system.profiles, number, state.clock.time + length)[0]
    followed = before if isnan(state.lagged[number]) else state.lagged[number]
    follows = ((1.0 - method.af) * after + method.af * before - method.am * followed) / (1.0 - method.am)
    return before, after, followed, follows

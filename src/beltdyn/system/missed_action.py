"""What acts on the shafts inside a time step, beside what a method of integration sees at the ends of the step.

A step that ends on both sides of a pulse, or on the same phase of a wave, sees nothing of it.  What is prescribed is
known everywhere: speeds, torques and schedules over time, and loads over speed and angle as far as the motion of the
step is known beforehand.  With d(t) the difference between an action and the straight line between its values at the
ends of the step, the step misses the integral of d: an angle of a prescribed speed, an angular impulse of a torque.
"""

from typing import Any, Final

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.machines.links import link_torque
from beltdyn.machines.loads.shaft import load_bend, load_torque, shaft_torque
from beltdyn.machines.profiles.functions import (
    NO_SCHEDULE,
    after_jump,
    prescribed_motion,
    profile_bend,
    profile_value,
    schedule_value,
)
from beltdyn.system.arrays import COUPLING_LOSS, DRIVER_WORK, TORQUE_WORK, Motion, NoCarriage, System
from beltdyn.system.frame import Flowing, FlowingByArcs, Travelling, flow_at_ends
from beltdyn.system.guide import Guided
from beltdyn.system.running_web import RunningWeb, gone_with_web

_PARTS: Final = 4
"""A step that holds a wave is seen in so many parts at least,"""
_PHASE: Final = 0.4
"""and the wave in parts of this phase, rad: the trapezoidal rule then errs by 1.3 % of it."""
_FINEST: Final = 1e-6
"""Shortest part of a step that is looked at, over the step."""


@kernel
def missed_action(system: System, source: int, motion: Motion, length: float, limit: float) -> tuple[float, float]:
    """Integral over a step of an action less the straight line between its values at the ends.

    `source`: a pulley, whose shaft has a prescribed speed or torques; or the number of pulleys and that of a link;
    `motion`: beginning of the step; `length`: length of the step, s; `limit`: the search ends where the integral gets
    larger than this. Returns largest, whole: largest absolute integral from the beginning of the step to any instant in
    it, and the integral over the whole step: rad for a prescribed speed, N m s else.
    """
    end = motion.time + length
    time = next_instant(system, source, motion, motion.time, length)
    if time >= end:
        return 0.0, 0.0
    first = action_at(system, source, motion, after_jump(motion.time))
    slope = (action_at(system, source, motion, end) - first) / length
    before, earlier, whole, largest = 0.0, motion.time, 0.0, 0.0
    while True:
        deviation, part = 0.0, time - earlier
        if time < end:
            deviation = action_at(system, source, motion, time) - first - slope * (time - motion.time)
        if before * deviation < 0.0:
            largest = max(largest, abs(whole + 0.5 * part * before * before / (before - deviation)))
        whole += 0.5 * part * (before + deviation)
        largest = max(largest, abs(whole))
        if time >= end or largest > limit:
            return largest, whole
        before, earlier = deviation, time
        time = next_instant(system, source, motion, time, length)


@kernel
def missed_impulses(system: System, motion: Motion, length: float, impulse: FloatArray) -> None:
    """Angular impulses on the bodies that the ends of a step miss.

    `motion`: beginning of the step; `length`: length of the step, s; `impulse`: overwritten by those of torques on the
    shafts, and those of links, in the places of the bodies, N m s, shape (2, n N + D).
    """
    impulse[:] = 0.0
    first = system.first_body
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown >= 0:
            impulse[0, first + body] += missed_action(system, p, motion, length, np.inf)[1]
    for number in range(system.links.size):
        whole = missed_action(system, system.pulleys.size + number, motion, length, np.inf)[1]
        impulse[1, first + system.links[number].front] -= whole
        impulse[1, first + system.links[number].back] += whole


@kernel
def missed_work(
    system: System,
    motion: Motion,
    end: Motion,
    impulse: FloatArray,
    work: FloatArray,
) -> None:
    """Works over a step that the trapezoidal rule for the powers at its ends misses.

    The impulse of torques on a free shaft does its work at the mean speed of the step, and the driver of a prescribed
    body does what the kinetic energy of the body changes by.

    `motion`, `end`: beginning and end of the step; `impulse`: from `missed_impulses`, shape (2, n N + D); `work`:
    overwritten, in the order of `POWERS`, J, shape (8,).
    """
    work[:] = 0.0
    first, length = system.first_body, end.time - motion.time
    for body in range(system.bodies.size):
        i = first + body
        before, after = motion.velocity[i], end.velocity[i]
        mean = 0.5 * (before + after)
        work[COUPLING_LOSS] -= impulse[1, i] * mean
        if system.bodies[body].unknown >= 0:
            work[TORQUE_WORK] += impulse[0, i] * mean
        else:
            power = before * motion.acceleration[i] + after * end.acceleration[i]
            gain = mean * (after - before) - 0.5 * length * power
            work[DRIVER_WORK] += system.bodies[body].inertia * gain - impulse[1, i] * mean
    for p in range(system.pulleys.size):
        i = first + system.pulleys[p].shaft
        if system.bodies[system.pulleys[p].shaft].unknown >= 0:
            before = extrapolated_torque(system, p, motion, after_jump(motion.time))
            after = extrapolated_torque(system, p, end, end.time)
            work[TORQUE_WORK] -= 0.25 * length * (after - before) * (end.velocity[i] - motion.velocity[i])


@np.errstate(under="ignore")  # below the least number is zero
def jump_work(system: System, before: FloatArray, after: FloatArray) -> float:
    """Work of drivers where prescribed speeds jump, J: the change of the kinetic energy of prescribed bodies."""
    first = system.first_body
    inertia = np.where(system.bodies.unknown < 0, system.bodies.inertia, 0.0)
    return float(0.5 * inertia @ (after[first:] ** 2 - before[first:] ** 2))


@kernel
def action_at(system: System, source: int, motion: Motion, time: float) -> float:
    """Prescribed speed, torque on a shaft or torque of a link at an instant of a step."""
    first = system.first_body
    if source >= system.pulleys.size:
        number = source - system.pulleys.size
        front, back = first + system.links[number].front, first + system.links[number].back
        twist = motion.position[front] - motion.position[back]
        rate = motion.velocity[front] - motion.velocity[back]
        return link_torque(system.profiles, system.links[number], time, twist, rate).torque
    if system.bodies[system.pulleys[source].shaft].unknown < 0:
        return prescribed_motion(system.profiles, source, time)[1]
    return extrapolated_torque(system, source, motion, time)


@kernel
def extrapolated_torque(system: System, pulley: int, motion: Motion, time: float) -> float:
    """Torque on a free shaft at an instant (s), with its motion extrapolated."""
    angle, speed = _extrapolated(system, pulley, motion, time)
    states = motion.position[system.first_body :]
    return shaft_torque(system.profiles, system.shaft_loads, pulley, time, angle, speed, states).torque


@kernel
def extrapolated_load(system: System, pulley: int, load: int, motion: Motion, time: float) -> float:
    """Torque of one load, with its schedule, on a shaft at an instant (s), with its motion extrapolated."""
    angle, speed = _extrapolated(system, pulley, motion, time)
    states = motion.position[system.first_body :]
    scale = schedule_value(system.profiles, system.shaft_loads.table[load].schedule, time)
    return scale * load_torque(system.profiles, system.shaft_loads, load, time, angle, speed, states).torque


@kernel(inline=True)
def _extrapolated(system: System, pulley: int, motion: Motion, time: float) -> tuple[float, float]:
    """Angle and speed of a shaft at an instant (s), with its acceleration kept while it lasts."""
    i, since = system.first_body + system.pulleys[pulley].shaft, time - motion.time
    lasting = _acceleration_lasts(system, pulley, motion, since)
    speed = motion.velocity[i] + lasting * motion.acceleration[i]
    return motion.position[i] + since * speed - 0.5 * lasting * (speed - motion.velocity[i]), speed


@kernel
def _acceleration_lasts(system: System, pulley: int, motion: Motion, since: float) -> float:
    """For how much of a time (s) since the beginning of a step a shaft's acceleration is kept.

    What slows a shaft lasts no longer than its own torque takes to stop it, J / |dM/dω|: a shaft that stiff dry
    friction holds trembles, and comes to rest long before the end of the step.
    """
    body = system.pulleys[pulley].shaft
    i = system.first_body + body
    if motion.velocity[i] * motion.acceleration[i] >= 0.0:
        return since
    angle, speed, states = motion.position[i], motion.velocity[i], motion.position[system.first_body :]
    start = after_jump(motion.time)
    slope = shaft_torque(system.profiles, system.shaft_loads, pulley, start, angle, speed, states).by_speed
    return min(since, -system.bodies[body].inertia / slope) if slope < 0.0 else since


@kernel
def next_instant(system: System, source: int, motion: Motion, time: float, length: float) -> float:
    """Next instant at which an action must be looked at: a kink, a part of a wave, or the end of the step."""
    profiles, end = system.profiles, motion.time + length
    if source >= system.pulleys.size:
        schedule = system.links[source - system.pulleys.size].schedule
        kink, frequency = profile_bend(profiles, schedule, time) if schedule != NO_SCHEDULE else (end, 0.0)
    else:
        kink, frequency = profile_bend(profiles, source, time)
        body = system.pulleys[source].shaft
        if system.bodies[body].unknown < 0:
            mean = abs(profile_value(profiles, source, time)[0])
            for h in range(profiles.table[source].harmonic, profiles.table[source + 1].harmonic):
                frequency = max(frequency, profiles.harmonic[h].order * mean)
        else:
            i, since = system.first_body + body, time - motion.time
            lasting = _acceleration_lasts(system, source, motion, since)
            speed = motion.velocity[i] + lasting * motion.acceleration[i]
            rate = 0.0 if lasting < since else motion.acceleration[i]
            for load in range(system.shaft_loads.first[source], system.shaft_loads.first[source + 1]):
                at, wave = load_bend(profiles, system.shaft_loads, load, time, speed, rate)
                kink, frequency = min(kink, at), max(frequency, wave)
    if frequency > 0.0:
        kink = min(kink, time + min(length / _PARTS, _PHASE / frequency))
    return min(end, max(kink, time + _FINEST * length))


# What the damping of the time integrator takes in a step, for the energy account


@kernel
def _no_flow(frame: Travelling, system: System, element: int, before: Motion, after: Motion, work: np.record) -> None:
    """Nodes move with the belt."""


@kernel
def _flow_of_step(frame: Flowing, system: System, element: int, before: Motion, after: Motion, work: np.record) -> None:
    """Make way, change of velocity, mean acceleration and mean velocity of an element those of material points."""
    passed = 0.5 * (after.position[frame.place] - before.position[frame.place])
    vectors, dof, node_j = system.vectors, len(system.scale), (element + 1) % system.nodes
    derivative, second, speed = frame.derivative[element], frame.second[element], work.element.gradient
    for end in range(2):
        motion, sign = (before, -1.0) if end == 0 else (after, 1.0)
        flow, change = motion.velocity[frame.place], motion.acceleration[frame.place]
        for a in range(len(vectors)):
            for axis in range(2):
                c = vectors[a] + axis
                rate = bend = turn = 0.0
                for b in range(len(vectors)):
                    k = vectors[b] + axis
                    i = dof * element + k if k < dof else dof * node_j + k - dof
                    rate += derivative[a, b] * motion.position[i]
                    bend += second[a, b] * motion.position[i]
                    turn += derivative[a, b] * motion.velocity[i]
                work.coordinates[0, c] += passed * rate
                work.coordinates[1, c] += sign * flow * rate
                work.coordinates[2, c] += 0.5 * (2.0 * flow * turn + change * rate + flow * flow * bend)
                speed[c] += 0.5 * flow * rate


@kernel
def _flow_by_arcs_of_step(
    frame: FlowingByArcs, system: System, element: int, before: Motion, after: Motion, work: np.record
) -> None:
    """The same where lengths of belt go over from one span to another; the element has its length after the step."""
    vectors, dof, node_j = system.vectors, len(system.scale), (element + 1) % system.nodes
    derivative, growth, speed = frame.derivative[element], frame.growth[element], work.element.gradient
    from_i, from_j = flow_at_ends(frame, element, before.position)
    to_i, to_j = flow_at_ends(frame, element, after.position)
    passed, more = 0.5 * (to_i - from_i), 0.5 * (to_j - from_j - to_i + from_i)
    for end in range(2):
        motion, sign = (before, -1.0) if end == 0 else (after, 1.0)
        first, last = flow_at_ends(frame, element, motion.velocity)
        rise, top = flow_at_ends(frame, element, motion.acceleration)
        for a in range(len(vectors)):
            for axis in range(2):
                c, own, change, way = vectors[a] + axis, 0.0, 0.0, 0.0
                for b in range(len(vectors)):
                    k = vectors[b] + axis
                    i = dof * element + k if k < dof else dof * node_j + k - dof
                    by, grown, moved, speed_b = derivative[a, b], growth[a, b], motion.position[i], motion.velocity[i]
                    flow = first * by + (last - first) * grown
                    way += (passed * by + more * grown) * moved
                    own += flow * moved
                    change += (rise * by + (top - rise) * grown) * moved + 2.0 * flow * speed_b
                    for d in range(len(vectors)):
                        k = vectors[d] + axis
                        i = dof * element + k if k < dof else dof * node_j + k - dof
                        change += flow * (first * derivative[b, d] + (last - first) * growth[b, d]) * motion.position[i]
                work.coordinates[0, c] += way
                work.coordinates[1, c] += sign * own
                work.coordinates[2, c] += 0.5 * change
                speed[c] += 0.5 * own


_add_flow_of_step = by_type(
    {Travelling: _no_flow, Flowing: _flow_of_step, FlowingByArcs: _flow_by_arcs_of_step}, "add_flow_of_step"
)
"""Make what nodes do in a step what material points do."""


@kernel
def numerical_loss(system: System, before: Motion, after: Motion, impulse: FloatArray, work: np.record) -> float:
    """Energy that the damping of the time integrator takes in a step.

    The change of the kinetic energy should be the work of the forces of inertia M a on the way of the step.  What
    generalized-alpha leaves between them is

        (a0 + a1)/2 . M (q1 - q0) - (v0 + v1)/2 . M (v1 - v0),

    which is exactly its dissipation where forces are linear in the positions: the mean of their values at both ends,
    times the way, is then their work.

    `system`: belt and bodies; `before`, `after`: both ends of the step; `impulse`: what acts on the bodies beside the
    forces at the ends, from `missed_impulses`, N m s, shape (2, n N + D); `work`: from `element_workspace`. Returns J;
    of belt and free bodies.
    """
    way, change, mean = work.coordinates[0], work.coordinates[1], work.coordinates[2]
    speed, taken, dof = work.element.gradient, work.element.tangent[0], len(system.scale)
    total = 0.0
    for element in range(system.length.size):
        node_j = (element + 1) % system.nodes
        for c in range(2 * dof):
            i = dof * element + c if c < dof else dof * node_j + c - dof
            way[c], change[c] = after.position[i] - before.position[i], after.velocity[i] - before.velocity[i]
            mean[c] = 0.5 * (after.acceleration[i] + before.acceleration[i])
            speed[c] = 0.5 * (after.velocity[i] + before.velocity[i])
        _add_flow_of_step(system.frame, system, element, before, after, work)
        mass = system.mass[element]
        taken[:] = 0.0
        for row in range(2 * dof):
            for column in range(2 * dof):  # no sum within the inner loop, which can then run on vectors
                taken[column] += mass[row, column] * (mean[row] * way[column] - speed[row] * change[column])
        for column in range(2 * dof):
            total += taken[column]
    first = system.first_body
    for body in range(system.bodies.size):
        if system.bodies[body].unknown >= 0:
            i = first + body
            inertia = 0.5 * (after.acceleration[i] + before.acceleration[i]) * (after.position[i] - before.position[i])
            momentum = 0.5 * (after.velocity[i] ** 2 - before.velocity[i] ** 2)
            given = 0.5 * (impulse[0, i] + impulse[1, i]) * (before.velocity[i] + after.velocity[i])
            total += system.bodies[body].kinetic * (inertia - momentum) + given
    return float(total - _gone_with_web(system.carriage, system, before, after, work))


@kernel(inline=True)
def _none_gone(carriage: Any, system: System, before: Motion, after: Motion, work: np.record) -> float:
    """The whole belt stays."""
    return 0.0


_gone_with_web = by_type({NoCarriage: _none_gone, Guided: _none_gone, RunningWeb: gone_with_web}, "gone_with_web")

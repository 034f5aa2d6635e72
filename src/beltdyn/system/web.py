"""A web line in steady running: material enters at one end of an open path and leaves at the other.

The web is held in place where it leaves the unwinder and where it reaches the winder, and as much unstretched length
passes both ends, c in a unit of time.  How much is between them follows from both tensions:

    N(|r'|) = T    at either end,    N the law of stretch.

Unknowns are c, as on a closed belt, and this content, as a factor on the lengths of all elements.  Power comes in and
goes out with the web: -/+ N c |r'| of the tension, +/- (W + rho A c^2 |r'|^2 / 2) c of what passes.
"""

from collections.abc import Callable
from math import pi
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, Records, record, records
from beltdyn.kernel import by_type, interpreted, kernel
from beltdyn.machines.profiles.functions import Profiles, profile_rows, profile_value
from beltdyn.model import Prepared
from beltdyn.stretch import stretching
from beltdyn.system.arrays import TORQUE_WORK, BodyForces, Equations, Motion, NoCarriage, System

ROLL = record(
    driven="i8",  # whether its torque is given, and not the tension of the web
    core_radius="f8",
    core_inertia="f8",
    length="f8",  # unstretched, at the beginning
    thickness="f8",
    mass="f8",  # of a meter of web
)
"""A roll of a web line."""


class WebEnds(NamedTuple):
    """Unwinder and winder of a web line."""

    tensions: FloatArray
    """Of the web there, of rolls with a torque in steady running, N, shape (2,)."""
    rolls: Records
    """Rows of `ROLL`, shape (2,)."""
    torque: Profiles
    """On the rolls, N m."""


def web_ends(prepared: Prepared) -> WebEnds:
    """The ends of a web line, as a run begins."""
    belt, ends = prepared.belt, prepared.drive.web_ends
    rolls = records(ROLL, driven=[one.torque is not None for one in ends])
    for row, one in zip(rolls, ends, strict=True):
        if one.roll is not None:
            row.core_radius, row.core_inertia = one.roll.core_radius, one.roll.core_inertia
            row.length, row.thickness = one.roll.length_of(belt.thickness), belt.thickness
            row.mass = belt.mass_per_length
    tensions = [one.tension_at(prepared.simulation.begin, belt.thickness) for one in ends]
    return WebEnds(np.array(tensions), rolls, profile_rows([one.torque for one in ends], [(), ()]))


def ends_at(ends: WebEnds, time: float) -> WebEnds:
    """The same with the tensions that torques on the rolls, as they begin, give at an instant (s)."""
    tensions = ends.tensions.copy()
    for end, roll in enumerate(ends.rolls):
        if roll.driven:
            tensions[end] = (
                interpreted(profile_value)(ends.torque, end, time)[0] / interpreted(size_of)(roll, 0.0).radius
            )
    return ends._replace(tensions=tensions)


def with_part_of_tensions(carriage: Any, tension: float, part: float) -> Any:
    """A web line with tensions at its ends on the way from a common one (N) to its own; any other carriage as it is."""
    if not isinstance(carriage, WebLine):
        return carriage
    ends = carriage.ends._replace(tensions=tension + part * (carriage.ends.tensions - tension))
    return carriage._replace(ends=ends)


class RollSize(NamedTuple):
    """What follows from the length that is wound."""

    radius: float
    """m."""
    inertia: float
    """kg m^2."""
    growth: float
    """Of the radius, over it, by a meter of web, 1/m."""


@kernel(inline=True)
def size_of(roll: np.record, gained: float) -> RollSize:
    """A roll with the length of web that it has gained since the beginning, m; negative if it has given it off."""
    length, core = max(0.0, roll.length + gained), roll.core_radius * roll.core_radius
    square = core + roll.thickness * length / pi
    inertia = roll.core_inertia + 0.5 * roll.mass * length * (square + core)
    return RollSize(square**0.5, inertia, 0.5 * roll.thickness / (pi * square))


class WebLine(NamedTuple):
    """A web that flows through a staying mesh, as much at both ends."""

    ends: WebEnds
    content: FloatArray
    """Lengths of the elements over those below, shape (1,)."""
    orders: FloatArray
    """Orders of the derivatives that the v vectors of an element are, shape (v,)."""
    length: FloatArray
    """As in `System`, with a content of 1, like all that follows."""
    control: FloatArray
    mass: FloatArray
    derivative: FloatArray
    """As in `frame.Staying`."""
    inertia: FloatArray
    force: FloatArray
    """Weight on the nodal coordinates, as in `Supports`."""


def web_line(system: System, ends: WebEnds, orders: FloatArray) -> System:
    """A system in a staying mesh with the ends of a web line, and arrays of its own that its content changes."""
    frame = system.frame._replace(derivative=system.frame.derivative.copy(), inertia=system.frame.inertia.copy())
    supports = system.supports._replace(force=system.supports.force.copy())
    given = system.length, system.control, system.mass, frame.derivative, frame.inertia, supports.force
    line = WebLine(ends, np.ones(1), orders, *(array.copy() for array in given))
    own = {name: getattr(system, name).copy() for name in ("length", "control", "mass")}
    return system._replace(frame=frame, carriage=line, supports=supports, **own)


def content(system: System) -> FloatArray:
    """Content of a web line over that of its arrays, shape (1,), or none of a belt, shape (0,)."""
    return system.carriage.content if isinstance(system.carriage, WebLine) else np.zeros(0)


def rebased(system: System) -> System:
    """The same web line with a content of 1; a belt as it is."""
    line = system.carriage
    return web_line(system, line.ends, line.orders) if isinstance(line, WebLine) else system


@kernel
def set_content(line: WebLine, system: System, value: float) -> None:
    """Give all elements the lengths of a content; their vectors stay."""
    orders, count, dof = line.orders, line.orders.size, len(system.scale)
    line.content[0] = value
    for at in range(line.force.size):
        system.supports.force[at] = value ** (orders[at % dof // 2] + 1.0) * line.force[at]
    for element in range(system.length.size):
        system.length[element] = value * line.length[element]
        for curve in range(line.control.shape[1]):
            for point in range(line.control.shape[2]):
                for a in range(count):
                    system.control[element, curve, point, a] = (
                        value ** orders[a] * line.control[element, curve, point, a]
                    )
        for a in range(count):
            for b in range(count):
                together = orders[a] + orders[b]
                system.frame.derivative[element, a, b] = (
                    value ** (orders[b] - orders[a] - 1.0) * line.derivative[element, a, b]
                )
                system.frame.inertia[element, a, b] = value ** (together - 1.0) * line.inertia[element, a, b]
                factor, i, j = value ** (together + 1.0), system.vectors[a], system.vectors[b]
                for axis in range(2):
                    for other in range(2):
                        system.mass[element, i + axis, j + other] = factor * line.mass[element, i + axis, j + other]


@kernel(inline=True)
def _no_content(carriage: Any, system: System, factor: float, border_part: FloatArray) -> None:
    """The length of a belt is known."""


@kernel
def _change_content(line: WebLine, system: System, factor: float, border_part: FloatArray) -> None:
    """The content is the last unknown but one."""
    set_content(line, system, line.content[0] + factor * border_part[border_part.size - 2])


@kernel(inline=True)
def _no_way(carriage: Any, border_part: FloatArray) -> float:
    return 0.0


@kernel(inline=True)
def _way_of_content(line: WebLine, border_part: FloatArray) -> float:
    whole = 0.0
    for element in range(line.length.size):
        whole += line.length[element]
    return float(abs(border_part[border_part.size - 2]) * whole)


@kernel
def hold_web(line: WebLine, system: System, motion: Motion, at_rest: bool, wanted: bool, equations: Equations) -> None:
    """The tensions at both ends as equations of the last two unknowns; at rest these stay as they are.

    `line`: the ends; `at_rest`: whether the web stands still, with the content that it has; `wanted`: whether the
    tangent is wanted; `equations`: changed in place.
    """
    matrix, dof = equations.matrix, len(system.scale)
    law = system.element.section.stretch
    for end in range(2):
        row, node = matrix.corner.shape[0] - 2 + end, end * (system.nodes - 1)
        if at_rest:
            if wanted:
                matrix.corner[row, row] = 1.0
            continue
        at = dof * node + system.turned
        x, y = motion.position[at], motion.position[at + 1]
        metric = x * x + y * y
        own, stretch = stretching(law, metric), metric**0.5
        matrix.border_side[row] = (2.0 * own.slope * stretch - line.ends.tensions[end]) / law.stiffness
        if wanted:
            by_square = (own.slope / stretch + 2.0 * own.curvature * stretch) / law.stiffness
            matrix.row[node, row, system.turned] = 2.0 * by_square * x
            matrix.row[node, row, system.turned + 1] = 2.0 * by_square * y


@kernel
def push_web(
    line: WebLine, system: System, motion: Motion, factors: Any, wanted: bool, corner: Any, forces: BodyForces
) -> None:
    """Add the power that comes in and goes out with the web to that of loads."""
    dof, section, speed = len(system.scale), system.element.section, system.frame.speed[0]
    for end in range(2):
        at = dof * end * (system.nodes - 1) + system.turned
        metric = motion.position[at] * motion.position[at] + motion.position[at + 1] * motion.position[at + 1]
        own = stretching(section.stretch, metric)
        power = speed * (2.0 * own.slope * metric - own.energy - 0.5 * section.mass * speed * speed * metric)
        forces.power[TORQUE_WORK] += power if end == 1 else -power


change_content: Callable[[Any, System, float, FloatArray], None] = by_type(
    {NoCarriage: _no_content, WebLine: _change_content}, "change_content"
)
"""Add factor times a solution to the content of a web line."""
way_of_content: Callable[[Any, FloatArray], float] = by_type(
    {NoCarriage: _no_way, WebLine: _way_of_content}, "way_of_content"
)
"""The change of content in a solution, m."""

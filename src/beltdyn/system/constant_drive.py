"""A system whose speeds, torques and loads stay as they are at an instant, as steady running takes it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray, Records, records
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines.links import link_torque
from beltdyn.machines.loads.shaft import mean_loads, shaft_torque
from beltdyn.machines.profiles.functions import PROFILE, profile_value
from beltdyn.machines.profiles.profile import SEGMENT
from beltdyn.system.arrays import Carrying, System
from beltdyn.system.body_forces import controls
from beltdyn.system.state import State
from beltdyn.system.web import WebLine, ends_at

# The speed at which motors and loads balance where nothing slips: the start of a search for steady running

_SPEEDS = np.geomspace(1e-2, 300.0, 100)
"""Speeds of the belt at which the balance is looked at, m/s."""


def operating_point(system: System, radii: FloatArray, prescribed: BoolArray) -> tuple[float, int | None]:
    """The belt's speed without slip, m/s in the sense of the path, and the driver where no speed is prescribed.

    Radii of the path are signed. ModelError if nothing drives.
    """
    from scipy.optimize import brentq

    driven = np.flatnonzero(prescribed)
    if driven.size:
        speeds = system.profiles.segment.offset[driven] * radii[driven]
        fastest = float(speeds[np.argmax(np.abs(speeds))])
        if fastest == 0.0:
            raise ModelError("nothing drives the belt: every prescribed speed is zero.")
        return fastest, None
    for sense in (1.0, -1.0):

        def pull(size: float, sense: float = sense) -> float:
            return sense * float(np.sum(_pulls(system, radii, sense * size)))

        pulls = np.array([pull(size) for size in _SPEEDS])
        crossing = np.flatnonzero((pulls[:-1] > 0.0) & (pulls[1:] <= 0.0))
        if crossing.size:
            k = int(crossing[0])
            speed = sense * brentq(pull, _SPEEDS[k], _SPEEDS[k + 1])
            return speed, int(np.argmax(sense * _pulls(system, radii, speed)))
    raise ModelError(
        "the drive has no operating point: its motors and loads balance at no speed. Prescribe a speed, use a "
        "motor stronger than the loads at rest, or a load that grows with speed."
    )


def _pulls(system: System, radii: FloatArray, speed: float) -> FloatArray:
    """Force with which each shaft pulls the belt along at a speed (m/s) without slip, N, shape (P,)."""
    torque, states = interpreted(shaft_torque), np.zeros(system.bodies.size)
    found = [
        torque(system.profiles, system.shaft_loads, p, 0.0, 0.0, speed / radius, states).torque / radius
        for p, radius in enumerate(radii)
    ]
    return np.array(found)


def without_actions(system: System) -> None:
    """Take speeds, torques and loads of a constant drive away, in place; goods stay."""
    kept = np.zeros(system.profiles.segment.size, dtype=bool)
    if isinstance(system.carrying, Carrying):
        schedules = np.asarray(system.carrying.goods.schedule)
        kept[schedules[schedules >= 0]] = True
    system.profiles.segment.offset[~kept] = 0.0


_OF_MOTION = ("damping", "tensioning_friction", "yielding_friction", "stop_damping")
"""Constants of a spring-loaded tensioner that matter while it moves."""


def constant_drive(system: System, time: float) -> System:
    """Hold everything that changes over time or with the angle of a shaft.

    Loads are taken by their means over the angle, and what acts on a tensioner only while it moves is left out. Trims
    of controllers have no limit. Each load has a schedule of its own.
    """
    loads, profiles = mean_loads(system.shaft_loads), system.profiles
    values = [interpreted(profile_value)(profiles, number, time)[0] for number in range(len(profiles.table) - 1)]
    factors = [values[number] if number >= 0 else 1.0 for number in loads.table.schedule[:-1]]
    table = loads.table.copy()
    for kind in table.dtype.names or ():
        if "largest_trim" in (table.dtype[kind].names or ()):
            table[kind]["largest_trim"] = np.inf
    table["schedule"][:-1] = len(values) + np.arange(len(factors))
    held = np.array([*values, *factors])
    return system._replace(
        profiles=profiles._replace(
            table=records(PROFILE, segment=np.arange(held.size + 1)),
            segment=records(SEGMENT, start=np.full(held.size, -np.inf), offset=held),
        ),
        shaft_loads=loads._replace(table=table),
        tensioners=without_motion(system.tensioners),
        carriage=_with_tensions(system.carriage, time),
    )


def _with_tensions(carriage: Any, time: float) -> Any:
    """A web line with the tensions that the torques of its rolls give at an instant; any other carriage as it is."""
    return carriage._replace(ends=ends_at(carriage.ends, time)) if isinstance(carriage, WebLine) else carriage


def without_motion(tensioners: Records) -> Records:
    """Tensioners without damping and dry friction."""
    still = tensioners.copy()
    fields = still.view(np.ndarray)
    for name in still.dtype.names or ():
        if "spring" in (still.dtype[name].names or ()):
            for constant in _OF_MOTION:
                fields[name]["spring"][constant] = 0.0
    return still


def dry_friction_of(tensioners: Records, name: str) -> FloatArray:
    """Constants "tensioning_friction" or "yielding_friction" of tensioners, N or N m; zero of kinds without spring."""
    found = np.zeros(tensioners.size)
    for kind in tensioners.dtype.names or ():
        if "spring" in (tensioners.dtype[kind].names or ()):
            found += tensioners[kind]["spring"][name]
    return found


def rigid_links(system: System) -> BoolArray:
    """Which links transmit a constant torque without a difference of speeds, as springs do; shape (L,)."""
    torque = interpreted(link_torque)
    found = [torque(system.profiles, link, 0.0, 0.0, 0.0).by_twist != 0.0 for link in system.links]
    return np.array(found, dtype=bool)


def with_speeds_unknown(system: System, held: Sequence[int] = ()) -> System:
    """The same system with the speeds of its shafts and rims as unknowns, equal where springs couple them."""
    bodies, group = system.bodies.copy(), np.arange(system.bodies.size)
    for link, rigid in zip(system.links, rigid_links(system), strict=True):
        if rigid:
            group[link.back] = group[link.front]
    shafts = system.pulleys.shaft
    driven = {*group[shafts[system.bodies.unknown[shafts] < 0]], *group[shafts[list(held)]]}
    free = sorted(set(group.tolist()) - {int(one) for one in driven})
    numbers = {one: number for number, one in enumerate(free)}
    bodies["unknown"] = [numbers.get(int(one), -1) for one in group]
    return system._replace(bodies=bodies)


def rim_of_bodies(system: System) -> IntArray:
    """Number of the pulley behind whose rim each body is, shape (D - K,)."""
    pulley = np.arange(system.bodies.size - system.tensioners.size)
    for link in system.links:
        pulley[link.back] = pulley[link.front]
    return pulley


def drive_shafts(system: System, velocity: FloatArray) -> None:
    """Set the known speeds of shafts, and of what springs couple to them, in `velocity`."""
    first, shafts = system.first_body, system.pulleys.shaft
    for p in np.flatnonzero(system.bodies.unknown[shafts] < 0):
        velocity[first + shafts[p]] = system.profiles.segment.offset[p]
    for link in system.links[::-1]:
        if system.bodies.unknown[link.front] < 0:
            velocity[first + link.front] = velocity[first + link.back]


def guess_hubs(system: System, velocity: FloatArray) -> None:
    """Guess speeds behind clutches in `velocity`: with the rim, or slower where the clutch slips."""
    from scipy.optimize import brentq

    first, torque, states = system.first_body, interpreted(shaft_torque), np.zeros(system.bodies.size)
    pulley, rigid = rim_of_bodies(system), rigid_links(system)
    shafts = system.pulleys.shaft
    for link, stiff in zip(system.links, rigid, strict=True):
        rim = float(velocity[first + link.front])
        velocity[first + link.back] = rim
        p = int(pulley[link.back])
        if stiff or rim == 0.0 or system.bodies.unknown[shafts[p]] < 0:
            continue

        def balance(part: float, link: np.record = link, rim: float = rim, p: int = p) -> float:
            driven = interpreted(link_torque)(system.profiles, link, 0.0, 0.0, (1.0 - part) * rim).torque
            return float(driven + torque(system.profiles, system.shaft_loads, p, 0.0, 0.0, part * rim, states).torque)

        if balance(1.0) != 0.0 and balance(0.0) * balance(1.0) <= 0.0:
            velocity[first + link.back] = rim * brentq(balance, 0.0, 1.0)


def own_torque(system: System, state: State, pulley: int, speed: float) -> float:
    """Torque of the loads and motors of a pulley at a speed (rad/s) of its shaft, N m."""
    states = state.position[system.first_body :]
    torque = interpreted(shaft_torque)
    return float(torque(system.profiles, system.shaft_loads, pulley, 0.0, 0.0, speed, states).torque)


def controllers(system: System) -> IntArray:
    """Numbers of the bodies that are states of controllers."""
    return np.flatnonzero([interpreted(controls)(body) for body in system.bodies])


def twists(system: System, moments: FloatArray, state: State) -> FloatArray:
    """Angles of rims and hub bodies against their shafts, shape (D - K,), from the moments of the belt, N m.

    In steady running each link of a hub chain transmits the moment of the belt. States of controllers are as given.
    """
    pulley, torque = rim_of_bodies(system), interpreted(link_torque)
    angles, held = np.zeros(pulley.size), controllers(system)
    angles[held] = state.position[system.first_body + held]
    for link in system.links[::-1]:
        stiffness = torque(system.profiles, link, 0.0, 0.0, 0.0).by_twist
        turned = moments[pulley[link.front]] / stiffness if stiffness != 0.0 else 0.0
        angles[link.front] = angles[link.back] + turned
    return angles

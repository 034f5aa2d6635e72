"""What loads and motors apply to a shaft, over time, speed and angle."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque
from beltdyn.machines.loads.registry import KINDS, SHAFT_LOAD, kink_of_kind, torque_of_kind
from beltdyn.machines.profiles.functions import Profiles, profile_bend, profile_value, schedule_value
from beltdyn.machines.profiles.harmonic import harmonic_factor, harmonic_rows
from beltdyn.records import Records, fill, offsets, records


class ShaftLoads(NamedTuple):
    """The loads on the shafts, sorted by pulley."""

    first: IntArray
    """First load of each pulley, shape (P + 1,)."""
    table: Records
    """Rows of `SHAFT_LOAD`, one more than there are loads."""
    point: FloatArray
    """Points of all loads, shape (n, 2)."""
    harmonic: Records
    """Rows of `HARMONIC`."""


def shaft_loads(loads: Sequence[Sequence[Load]], schedules: Sequence[int]) -> ShaftLoads:
    """Loads of all pulleys laid end to end.

    Parameters
    ----------
    loads
        Those of each pulley.
    schedules
        Numbers of the profiles that are their schedules, or `NO_SCHEDULE`.
    """
    found = [load for group in loads for load in group]
    first, harmonic = harmonic_rows([load.harmonics for load in found])
    table = records(SHAFT_LOAD, harmonic=first, point=offsets(len(load.points) for load in found))
    names = list(KINDS)
    for row, load, schedule in zip(table[:-1], found, schedules, strict=True):
        row.kind, row.schedule = names.index(load.kind), schedule
        fill(row[load.kind], load.values())
    point = np.array([point for load in found for point in load.points], dtype=float).reshape(-1, 2)
    return ShaftLoads(offsets(map(len, loads)), table, point, harmonic)


@kernel
def shaft_torque(
    profiles: Profiles, loads: ShaftLoads, pulley: int, time: float, angle: float, speed: float
) -> LoadTorque:
    """Torque on the shaft of a free pulley: its profile over time, and its loads.

    A load is schedule(t) f(theta, omega) (1 + sum a_k cos(k theta + phi_k)), with f of its kind.

    Parameters
    ----------
    profiles, loads
        Functions of time, and loads.
    pulley
        Which one.
    time
        s.
    angle, speed
        Angle theta and speed omega of the shaft, rad and rad/s, counter-clockwise.
    """
    total, by_angle, by_speed = profile_value(profiles, pulley, time)[0], 0.0, 0.0
    for number in range(loads.first[pulley], loads.first[pulley + 1]):
        scale = schedule_value(profiles, loads.table[number].schedule, time)
        load = load_torque(loads, number, angle, speed)
        total += scale * load.torque
        by_angle += scale * load.by_angle
        by_speed += scale * load.by_speed
    return LoadTorque(total, by_angle, by_speed)


@kernel
def load_torque(loads: ShaftLoads, number: int, angle: float, speed: float) -> LoadTorque:
    """Torque of a load without its schedule; arguments as for `shaft_torque`."""
    item, following = loads.table[number], loads.table[number + 1]
    plain = torque_of_kind(item, loads.point[item.point : following.point], angle, speed)
    factor, change = harmonic_factor(loads.harmonic, item.harmonic, following.harmonic, angle)
    by_angle = plain.by_angle * factor + plain.torque * change
    return LoadTorque(plain.torque * factor, by_angle, plain.by_speed * factor)


@kernel
def load_bend(
    profiles: Profiles, loads: ShaftLoads, number: int, time: float, speed: float, rate: float
) -> tuple[float, float]:
    """Where a load bends, with a speed that changes evenly.

    Parameters
    ----------
    profiles, loads
        Functions of time, and loads.
    number
        Which load.
    time
        s.
    speed, rate
        Speed of the shaft at that time, rad/s, and its rate, rad/s^2.

    Returns
    -------
    kink, frequency : float
        Next instant of a kink, s, infinite without any; the highest angular frequency of its waves, rad/s.
    """
    item, following = loads.table[number], loads.table[number + 1]
    kink, frequency = np.inf, 0.0
    if item.schedule >= 0:
        kink, frequency = profile_bend(profiles, item.schedule, time)
    for h in range(item.harmonic, following.harmonic):
        frequency = max(frequency, loads.harmonic[h].order * abs(speed))
    if rate != 0.0:
        ahead = kink_of_kind(item, loads.point[item.point : following.point], speed, rate > 0.0)
        if ahead < np.inf:
            kink = min(kink, time + (ahead - speed) / rate)
    return kink, frequency

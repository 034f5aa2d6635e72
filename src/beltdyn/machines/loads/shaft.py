"""Torques of loads and motors on a shaft, over time, speed and angle."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, Records, offsets, records
from beltdyn.kernel import kernel, labels
from beltdyn.machines.loads import (
    NO_STATE,
    SHAFT_LOADS,
    kink_of_kind,
    rate_of_kind,
    slope_of_kind,
    torque_of_kind,
)
from beltdyn.machines.loads.load import LOADS, Load, LoadTorque, SensorSlope, ShaftState, StateRate
from beltdyn.machines.profiles.functions import Profiles, command_value, profile_bend, profile_value, schedule_value
from beltdyn.machines.profiles.harmonic import harmonic_factor, harmonic_rows
from beltdyn.machines.tensioners.tensioner import MovingTensioner

NO_SENSORS: Mapping[str, "Sensor"] = MappingProxyType({})


class ShaftLoads(NamedTuple):
    """The loads on the shafts, sorted by pulley."""

    first: IntArray
    """First load of each pulley, shape (P + 1,)."""
    table: Records
    """Rows of `SHAFT_LOAD`, one more than there are loads."""
    numbers: FloatArray
    """Numbers of all loads, shape (n,)."""
    harmonic: Records
    """Rows of `HARMONIC`."""


class Sensor(NamedTuple):
    """A tensioner that a load sees."""

    place: int
    """Of its coordinate, counted from the last one on, from 1."""
    tensioner: MovingTensioner
    arm: float
    """Way of the carried pulley's center over the coordinate."""


def shaft_loads(
    loads: Sequence[Sequence[Load]],
    profiles: Sequence[tuple[int, int]],
    first_state: int,
    sensors: Mapping[str, Sensor] = NO_SENSORS,
) -> ShaftLoads:
    """Loads of all pulleys, concatenated; sensors by the names of their pulleys."""
    found = [load for group in loads for load in group]
    first, harmonic = harmonic_rows([load.harmonics for load in found])
    own = [np.asarray(load.numbers, dtype=float) for load in found]
    table = records(SHAFT_LOADS.row_type(map(type, found)), harmonic=first, number=offsets(map(len, own)))
    for row, load, (factor, command) in zip(table[:-1], found, profiles, strict=True):
        row.schedule, row.command = factor, command
        row.order, row.state = max(load.orders, default=0.0), NO_STATE
        if load.state_lag is not None:
            row.state, first_state = first_state, first_state + 1
        if load.sensed is not None:
            sensor = sensors[load.sensed]
            row.sensor = sensor.place
            row.sensor_rate, row.sensor_zero = load.error_of(sensor.tensioner, sensor.arm)
        SHAFT_LOADS.fill(row, type(load), load.values())
    return ShaftLoads(offsets(map(len, loads)), table, np.concatenate([np.zeros(0), *own]), harmonic)


def mean_loads(loads: ShaftLoads) -> ShaftLoads:
    """Loads by their means over shaft angles."""
    table, numbers, kinds = loads.table.copy(), loads.numbers.copy(), labels(loads.table.dtype)
    for row, following in pairwise(loads.table):
        label = kinds[row.kind]
        own = slice(row.number, following.number)
        numbers[own] = LOADS.labelled[label].mean_numbers(row[label], numbers[own])
    table["harmonic"] = 0
    return loads._replace(table=table, numbers=numbers)


@kernel
def shaft_torque(
    profiles: Profiles, loads: ShaftLoads, pulley: int, time: float, angle: float, speed: float, states: FloatArray
) -> LoadTorque:
    """Torque on the shaft of a free pulley: its profile over time, and its loads.

    A load is schedule(t) f(t, theta, omega) (1 + sum a_k cos(k theta + phi_k)), with f of its kind.

    `time`: s; `angle`, `speed`: angle theta and speed omega of the shaft, rad and rad/s, counter-clockwise; `states`:
    coordinates of the bodies, among them the states of controllers, shape (D,).
    """
    total, by_angle, by_speed = profile_value(profiles, pulley, time)[0], 0.0, 0.0
    for number in range(loads.first[pulley], loads.first[pulley + 1]):
        scale = schedule_value(profiles, loads.table[number].schedule, time)
        load = load_torque(profiles, loads, number, time, angle, speed, states)
        total += scale * load.torque
        by_angle += scale * load.by_angle
        by_speed += scale * load.by_speed
    return LoadTorque(total, by_angle, by_speed, 0.0)


@kernel
def load_torque(
    profiles: Profiles, loads: ShaftLoads, number: int, time: float, angle: float, speed: float, states: FloatArray
) -> LoadTorque:
    """Torque of a load without its schedule; arguments as for `shaft_torque`."""
    item, following = loads.table[number], loads.table[number + 1]
    shaft = _shaft(profiles, item, time, angle, speed, states)
    plain = torque_of_kind(item, loads.numbers[item.number : following.number], shaft)
    factor, change = harmonic_factor(loads.harmonic, item.harmonic, following.harmonic, angle)
    by_angle = plain.by_angle * factor + plain.torque * change
    return LoadTorque(plain.torque * factor, by_angle, plain.by_speed * factor, plain.by_command * factor)


@kernel(inline=True)
def _shaft(
    profiles: Profiles, item: np.record, time: float, angle: float, speed: float, states: FloatArray
) -> ShaftState:
    """What a load feels."""
    state = states[item.state] if item.state >= 0 else 0.0
    error = item.sensor_zero
    if item.sensor > 0:
        error += item.sensor_rate * states[states.size - item.sensor]
    return ShaftState(time, angle, speed, command_value(profiles, item.command, time), state, error)


@kernel
def state_rate(
    profiles: Profiles, loads: ShaftLoads, number: int, time: float, angle: float, speed: float, states: FloatArray
) -> StateRate:
    """Rate of the state of a load's controller, with its effect on the torque.

    Arguments are those of `shaft_torque`; the load has such a state.
    """
    item, following = loads.table[number], loads.table[number + 1]
    shaft = _shaft(profiles, item, time, angle, speed, states)
    plain = rate_of_kind(item, loads.numbers[item.number : following.number], shaft)
    factor = harmonic_factor(loads.harmonic, item.harmonic, following.harmonic, angle)[0]
    scale = factor * schedule_value(profiles, item.schedule, time)
    return StateRate(plain.rate, plain.by_speed, plain.by_state, scale * plain.torque_by_state)


@kernel
def sensor_slope(
    profiles: Profiles, loads: ShaftLoads, number: int, time: float, angle: float, speed: float, states: FloatArray
) -> SensorSlope:
    """Derivatives of a load with a sensor, and of the rate of its state, with respect to the sensor's coordinate.

    Arguments are those of `shaft_torque`.
    """
    item, following = loads.table[number], loads.table[number + 1]
    shaft = _shaft(profiles, item, time, angle, speed, states)
    plain = slope_of_kind(item, loads.numbers[item.number : following.number], shaft)
    factor = harmonic_factor(loads.harmonic, item.harmonic, following.harmonic, angle)[0]
    scale = factor * schedule_value(profiles, item.schedule, time)
    return SensorSlope(scale * plain.torque * item.sensor_rate, plain.rate * item.sensor_rate)


@kernel
def load_bend(
    profiles: Profiles, loads: ShaftLoads, number: int, time: float, speed: float, rate: float
) -> tuple[float, float]:
    """Next kink of a load at constant acceleration and its present command.

    `time`: s; `speed`, `rate`: speed of the shaft at that time, rad/s, and its rate, rad/s^2. Returns kink, frequency:
    next instant of a kink, s, infinite without any; the highest angular frequency of its waves, rad/s.
    """
    item, following = loads.table[number], loads.table[number + 1]
    kink, frequency = np.inf, item.order * abs(speed)
    for profile in (item.schedule, item.command):
        if profile >= 0:
            at, wave = profile_bend(profiles, profile, time)
            kink, frequency = min(kink, at), max(frequency, wave)
    if rate != 0.0:
        shaft = ShaftState(time, 0.0, speed, command_value(profiles, item.command, time), 0.0, 0.0)
        ahead = kink_of_kind(item, loads.numbers[item.number : following.number], shaft, rate > 0.0)
        if ahead < np.inf:
            kink = min(kink, time + (ahead - speed) / rate)
    return kink, frequency

"""Results that a study watches at its operating points: by name, distances of modes from orders, and clearances."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.found_state import FoundState
from beltdyn.designs.named_results import unit_of
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.model.carrier import moved
from beltdyn.model.path import Surroundings, distance_from_belt
from beltdyn.model.study import Obstacle, Order, Points
from beltdyn.parts.quantity import RPM, numbers_in
from beltdyn.points.changed_drive import driver_of
from beltdyn.points.duty import at_row, durations_of, read_duty
from beltdyn.points.operating_points import at_point, load_factors
from beltdyn.transient.sweep import without_schedules

# The operating points of a study: rows of a duty table, or places of a map


class OperatingPoint(NamedTuple):
    """An operating point of a study."""

    label: str
    """In words."""
    weight: float
    """Of its results in means; all sum up to 1."""
    of: Callable[[Drive], Drive]
    """A drive with constant speeds and torques -> the same at this point."""


def held(drive: Drive, points: Points) -> Drive:
    """The drive with speeds, torques and schedules as they are at the instant of a study."""
    return without_schedules(drive, drive.simulation.end if points.at is None else points.at)[0]


def study_points(drive: Drive, points: Points, base: Path) -> list[OperatingPoint]:
    """The operating points of a study."""
    if points.table is not None:
        columns = read_duty(base / points.table)
        durations = durations_of(columns)
        return [
            OperatingPoint(f"row {row + 1}", weight, partial(at_row, columns=columns, row=row))
            for row, weight in enumerate((durations / durations.sum()).tolist())
        ]
    if points.speed is None and points.load is None:
        return [OperatingPoint("as the drive file says", 1.0, lambda one: one)]
    at_rest = held(drive, points)
    number = driver_of(at_rest) if points.pulley is None else drive.number_of(points.pulley)
    axes = dict[str, FloatArray]()
    if points.load is not None:
        axes["load"] = load_factors(points.load, points.load_count)
    if points.speed is not None:
        axes["speed"] = numbers_in("speed", points.speed, "rad/s", points.count)
    places = [dict(zip(axes, map(float, place), strict=True)) for place in product(*axes.values())]
    return [
        OperatingPoint(_words(there), 1.0 / len(places), partial(at_point, pulley=number, there=there))
        for there in places
    ]


def _words(there: dict[str, float]) -> str:
    """An operating point in words."""
    told = {"speed": lambda value: f"{RPM * value:.4g} rpm", "load": lambda value: f"load {value:.3g}"}
    return ", ".join(told[name](there[name]) for name in ("speed", "load") if name in there)


def speed_of(drive: Drive, pulley: int) -> float:
    """Prescribed speed of a pulley at an operating point, rad/s; NaN without one."""
    speed = drive.pulleys[pulley].speed
    return np.nan if speed is None else abs(float(speed.at([0.0])[0]))


@dataclass(frozen=True)
class Watched:
    """A result that a study looks at."""

    name: str
    unit: str
    """SI unit; empty for a pure number."""
    read: Callable[[FoundState], float]
    at: FloatArray
    """1 at the operating points at which it counts, 0 at others."""


def named(name: str, drive: Drive, count: int) -> Watched:
    """A result of steady running."""
    return Watched(name, unit_of(name, drive), lambda state: state.value(name), np.ones(count))


def distance_from_order(order: Order, drive: Drive, points: Sequence[OperatingPoint]) -> Watched:
    """How far the nearest mode is from the band of frequencies of an order, over the end of the band that is near."""
    number = driver_of(drive) if order.pulley is None else drive.number_of(order.pulley)
    name = drive.pulleys[number].name
    speeds = np.array([speed_of(point.of(drive), number) for point in points])
    inside = (speeds >= order.least_speed * (1.0 - 1e-9)) & (speeds <= order.largest_speed * (1.0 + 1e-9))
    if not inside.any():
        raise ModelError(
            f"order {order.order:g} of {name} counts from {RPM * order.least_speed:g} to "
            f"{RPM * order.largest_speed:g} rpm, but no operating point prescribes a speed of {name} in this "
            "range. Add one under [points]."
        )
    low, high = (order.order * speed / (2.0 * np.pi) for speed in (order.least_speed, order.largest_speed))

    def read(state: FoundState) -> float:
        frequencies, kinds = state.modes_up_to((1.0 + order.distance) * high)
        counted = frequencies[[kind in order.kinds for kind in kinds]]
        return float(np.min(np.maximum(counted / high - 1.0, 1.0 - counted / low), initial=np.inf))

    return Watched(f"modes from order {order.order:g} of {name}", "", read, inside.astype(float))


def clearance(one: Obstacle, count: int) -> Watched:
    """Distance of a round part from the surface of the belt, with straight spans."""

    def read(state: FoundState) -> float:
        drive = state.drive
        positions = np.array([state.value(f"tensioner_position[{one.pulley}]") for one in drive.moving_tensioners])
        path, belt = moved(drive.path, prepare(drive).carriers, positions), drive.belt
        radii = np.array([pulley.radius for pulley in drive.pulleys])
        around = Surroundings(radii, belt.pitch_offset, belt.back_offset)
        return distance_from_belt(path, around, one.center, one.radius)

    return Watched(f"clearance of {one.name}", "m", read, np.ones(count))

"""Results that a study watches at its operating points: by name, distances of modes from orders, and clearances."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.carrier import moved
from beltdyn.model.clearance import Surroundings, distance_from_belt
from beltdyn.model.study import Obstacle, Order
from beltdyn.parts.quantity import RPM
from beltdyn.solve.steady_running.changed_drive import driver_of
from beltdyn.solve.studies.found_state import FoundState
from beltdyn.solve.studies.named_results import unit_of
from beltdyn.solve.studies.study_points import OperatingPoint, speed_of


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
    """A result of steady running.

    Parameters
    ----------
    name
        Such as "hub_load[driven]".
    drive
        The drive.
    count
        Number of operating points.
    """
    return Watched(name, unit_of(name, drive), lambda state: state.value(name), np.ones(count))


def distance_from_order(order: Order, drive: Drive, points: Sequence[OperatingPoint]) -> Watched:
    """How far the nearest mode is from the band of frequencies of an order, over the end of the band that is near.

    Parameters
    ----------
    order
        The order, and the speeds between which it counts.
    drive
        The drive, with constant speeds and torques.
    points
        The operating points.

    Raises
    ------
    ModelError
        If there is no such pulley, or no operating point between the speeds.
    """
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
    """Distance of a round part from the surface of the belt, with straight spans.

    Parameters
    ----------
    one
        The part.
    count
        Number of operating points.
    """

    def read(state: FoundState) -> float:
        drive = state.drive
        positions = np.array([state.value(f"tensioner_position[{one.pulley}]") for one in drive.moving_tensioners])
        path, belt = moved(drive.path, drive.carriers, positions), drive.belt
        radii = np.array([pulley.radius for pulley in drive.pulleys])
        around = Surroundings(radii, belt.pitch_offset, belt.back_offset)
        return distance_from_belt(path, around, one.center, one.radius)

    return Watched(f"clearance of {one.name}", "m", read, np.ones(count))

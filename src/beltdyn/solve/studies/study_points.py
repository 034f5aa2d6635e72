"""The operating points of a study: rows of a duty table, or places of a map."""

from collections.abc import Callable
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.model.study import Points
from beltdyn.parts.number_range import numbers_in
from beltdyn.parts.quantity import RPM
from beltdyn.solve.duty import at_row, durations_of, read_duty
from beltdyn.solve.operating_map import at_point, load_factors
from beltdyn.solve.steady_running.changed_drive import driver_of
from beltdyn.solve.sweep import without_schedules


class OperatingPoint(NamedTuple):
    """An operating point of a study."""

    label: str
    """In words."""
    weight: float
    """Of its results in means; all sum up to 1."""
    of: Callable[[Drive], Drive]
    """A drive with constant speeds and torques -> the same at this point."""


def held(drive: Drive, points: Points) -> Drive:
    """The drive with speeds, torques and schedules as they are at the instant of a study.

    Parameters
    ----------
    drive
        The drive.
    points
        The operating points of the study.
    """
    return without_schedules(drive, drive.simulation.end if points.at is None else points.at)[0]


def study_points(drive: Drive, points: Points, base: Path) -> list[OperatingPoint]:
    """The operating points of a study.

    Parameters
    ----------
    drive
        The drive.
    points
        As the study gives them; without any, the drive has one.
    base
        Folder from which paths of tables start.

    Raises
    ------
    ModelError
        If a table cannot be read, a text is no range, or there is no such pulley.
    """
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
    """Prescribed speed of a pulley at an operating point, rad/s; NaN without one.

    Parameters
    ----------
    drive
        The drive there.
    pulley
        Number of the pulley.
    """
    speed = drive.pulleys[pulley].speed
    return np.nan if speed is None else abs(float(speed.at([0.0])[0]))

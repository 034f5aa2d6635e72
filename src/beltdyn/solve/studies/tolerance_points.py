"""Monte Carlo on tolerances: results at Sobol points of numbers that scatter normally and independently."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.study import Points
from beltdyn.parts.change import unit_at, value_at
from beltdyn.solve.studies.designs import Designs, Free
from beltdyn.solve.studies.study_points import OperatingPoint
from beltdyn.solve.studies.watched import named

DEVIATIONS = 2.0
"""Standard deviations in a tolerance: 95 % of all numbers lie within it."""
_REACH = 4.0
"""Tolerances between a number and its bounds, beyond which no point lies."""


def require_points(count: int) -> None:
    """Make sure that Sobol points are balanced.

    Raises
    ------
    ModelError
        If there are not 2, 4, 8, ... of them.
    """
    if count < 0 or (count and count & (count - 1)) or count == 1:
        raise ModelError(f"sobol = {count} must be a power of two, such as 64 or 256.")


def results_at_points(
    drive: Drive,
    tolerances: Mapping[str, float],
    names: Sequence[str],
    count: int,
    *,
    at_rest: bool,
    force_tolerance: float | None,
    tell: Callable[[int], None],
) -> tuple[FloatArray, list[str]]:
    """Results at scattered numbers, each point followed from the drive as it is.

    Parameters
    ----------
    drive
        With constant speeds and torques.
    tolerances
        Path -> tolerance.
    names
        Of results.
    count
        Number of points.
    at_rest, force_tolerance
        As for `Designs`.
    tell
        Called with the number of points that are done.

    Returns
    -------
    values : ndarray, shape (points that run, results)
    failures : list of str
        Why the others do not.
    """
    from scipy.stats import norm, qmc

    numbers = [_free(drive, path, tolerance) for path, tolerance in tolerances.items()]
    points = [OperatingPoint("as the drive file says", 1.0, lambda one: one)]
    watched = [named(name, drive, 1) for name in names]
    designs = Designs(drive, numbers, points, Points(), watched, force_tolerance, lambda part: None, at_rest=at_rest)
    start = designs.find({one.path: one.start for one in numbers})
    designs.derivatives(start)
    scattered = norm.ppf(qmc.Sobol(len(numbers), rng=0).random(count)) / DEVIATIONS
    values, failures = list[FloatArray](), list[str]()
    for place, row in enumerate(scattered):
        changes = {
            one.path: one.start + float(part) * tolerances[one.path] for one, part in zip(numbers, row, strict=True)
        }
        found = designs.find(changes, start)
        if found.failure:
            failures.append(found.failure)
        else:
            values.append(found.values[0])
        tell(place + 1)
    return np.array(values).reshape(-1, len(names)), failures


def _free(drive: Drive, path: str, tolerance: float) -> Free:
    """A number with its tolerance."""
    value, away = float(value_at(drive, path)), _REACH * tolerance
    return Free(path, unit_at(drive, path).replace("*", " "), value - away, value + away, value)

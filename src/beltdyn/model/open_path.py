"""The path of an open belt."""

from collections.abc import Sequence

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.end import PathEnd, pulling
from beltdyn.model.path import Path

_ANY_LENGTH = 1.0  # m


def open_path(centers: FloatArray, radii: FloatArray, ends: Sequence[PathEnd], belt: Belt) -> Path:
    """Lay the path of an open belt around pulleys.

    The span to a pulled end runs along the force, and is as long as the belt, stretched by that force, leaves it.

    Parameters
    ----------
    centers : ndarray, shape (n, 2), m
        Centers of the pulleys.
    radii : ndarray, shape (n,), m
        Signed radii.
    ends : sequence of PathEnd
        The first and the second end.
    belt : Belt
        Its length, where an end is pulled.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If a belt with a pulled end has no length, or one that does not reach beyond the pulleys.
    """
    along = [np.zeros(2) if end.pull is None else end.pull / np.linalg.norm(end.pull) for end in ends]
    points = np.array(
        [
            _beyond(centers[pulley], radii[pulley] * sense, way) if end.point is None else end.point
            for end, way, pulley, sense in zip(ends, along, (0, -1), (-1, 1), strict=True)
        ]
    )
    path, tension = Path(centers, radii, points), pulling(tuple(ends))
    if tension is None:
        return path
    if belt.length is None:
        raise ValueError(
            f"belt.installed_tension = {belt.installed_tension:.5g} N contradicts the pulled end, which sets the "
            "tension of the belt. Give belt.length instead"
        )
    missing = belt.length * float(belt.stretch_parameters.stretch(tension)) - path.length
    if missing <= -_ANY_LENGTH:
        name = next(end.name for end in ends if end.pull is not None)
        raise ValueError(
            f'belt.length = {belt.length:.5g} m is too short: end "{name}" would lie on a pulley. Give the belt more '
            f"than {(path.length - _ANY_LENGTH) / (path.length + missing) * belt.length:.5g} m"
        )
    return Path(centers, radii, points + missing * np.array(along))


def _beyond(center: FloatArray, radius: float, way: FloatArray) -> FloatArray:
    """A point on the tangent of a circle of signed radius (m) that leaves it in a direction."""
    return np.asarray(center - radius * np.array([-way[1], way[0]]) + _ANY_LENGTH * way)

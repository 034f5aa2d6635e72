"""Where a path would cross itself, or run through a pulley or through belt that lies on one."""

from itertools import combinations
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.model.path import Path


class Obstacle(NamedTuple):
    """A pulley that a piece of belt would run through."""

    piece: Literal["span", "arc"]
    number: int
    """Of the span or of the pulley of the arc."""
    pulley: int


class Surroundings(NamedTuple):
    """What a path must keep away from, and what the belt needs on its two sides."""

    radii: FloatArray
    """Radii of the pulleys themselves, shape (n,), m."""
    inside: float
    """Distance from the path to the inside surface of the belt, m."""
    back: float
    """Distance from the path to the back of the belt, m."""


def crossings(path: Path) -> list[tuple[int, int]]:
    """Pairs of spans that cross each other.

    Parameters
    ----------
    path : Path

    Returns
    -------
    list of tuple
        Numbers of two spans, the smaller first.
    """
    starts, directions, lengths = path.span_points[:, 0], path.span_directions, path.span_lengths
    found = []
    for one, other in combinations(range(path.spans), 2):
        sine = _cross(directions[one], directions[other])
        between = starts[other] - starts[one]
        if sine != 0.0:
            along, across = (_cross(between, directions[span]) / sine for span in (other, one))
            if 0.0 < along < lengths[one] and 0.0 < across < lengths[other]:
                found.append((one, other))
    return found


def obstacle(path: Path, around: Surroundings) -> Obstacle | None:
    """Find a pulley, or belt that lies on it, in the way of a span or of an arc on another pulley.

    Parameters
    ----------
    path : Path
    around : Surroundings

    Returns
    -------
    Obstacle or None
        The first that is found.
    """
    for arc in range(path.count):
        for pulley in range(path.count):
            between = path.centers[pulley] - path.centers[arc]
            if pulley == arc or not _covers(path, arc, between):
                continue
            if np.linalg.norm(between) < _extent(path, around, arc, between) + _extent(path, around, pulley, -between):
                return Obstacle("arc", arc, pulley)
    for span, (start, direction) in enumerate(zip(path.span_points[:, 0], path.span_directions, strict=True)):
        for pulley in range(path.count):
            if pulley in (span, (span + 1) % path.spans):
                continue
            across = path.centers[pulley] - start
            nearest = across - np.clip(across @ direction, 0, path.span_lengths[span]) * direction
            facing = around.inside if _cross(direction, across) > 0 else around.back
            if np.linalg.norm(nearest) < _extent(path, around, pulley, -nearest) + facing:
                return Obstacle("span", span, pulley)
    return None


def distance_from_belt(path: Path, around: Surroundings, center: ArrayLike, radius: float) -> float:
    """Least distance of a round part from the surfaces of the belt, m; below zero where they overlap.

    Parameters
    ----------
    path : Path
    around : Surroundings
    center : array_like, shape (2,)
        Center of the part, m.
    radius : float
        Its radius, m.
    """
    found, place = list[float](), np.asarray(center, dtype=float)
    for start, direction, length in zip(
        path.span_points[:, 0], path.span_directions, path.span_lengths.tolist(), strict=True
    ):
        across = place - start
        nearest = across - np.clip(across @ direction, 0.0, length) * direction
        surface = around.inside if _cross(direction, across) > 0.0 else around.back
        found.append(float(np.linalg.norm(nearest)) - surface)
    for arc in range(path.count):
        between = place - path.centers[arc]
        if _covers(path, arc, between):
            above = float(np.linalg.norm(between)) - abs(float(path.radii[arc]))
            outwards = (above > 0.0) == (path.radii[arc] > 0.0)
            found.append(abs(above) - (around.back if outwards else around.inside))
    return min(found) - radius


def _extent(path: Path, around: Surroundings, pulley: int, direction: FloatArray) -> float:
    """How far a pulley reaches in a direction, with the belt on it where it lies there, m."""
    if not _covers(path, pulley, direction):
        return float(around.radii[pulley])
    return float(abs(path.radii[pulley]) + (around.back if path.radii[pulley] > 0 else around.inside))


def _covers(path: Path, pulley: int, direction: FloatArray) -> bool:
    """Tell whether belt lies on a pulley in a direction from its center."""
    sense = np.sign(path.radii[pulley])
    enters = path.span_points[pulley - 1, 1] - path.centers[pulley]
    angle = sense * np.arctan2(_cross(enters, direction), enters @ direction)
    return bool(angle % (2 * np.pi) <= path.wrap_angles[pulley])


def _cross(one: FloatArray, other: FloatArray) -> float:
    return float(one[0] * other[1] - one[1] * other[0])

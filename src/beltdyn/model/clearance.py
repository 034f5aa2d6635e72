"""Collisions of a path with itself, with pulleys and with the belt on them."""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.model.path import Path


class Obstacle(NamedTuple):
    """A pulley that a piece of belt collides with."""

    piece: Literal["span", "arc"]
    number: int
    """Number of the span, or of the pulley of the arc."""
    pulley: int


class Surroundings(NamedTuple):
    """Obstacles of a path, and the thickness of the belt on its two sides."""

    radii: FloatArray
    """Geometric radii of the pulleys, shape (n,), m."""
    inside: float
    """Distance from the path to the inside surface of the belt, m."""
    back: float
    """Distance from the path to the back of the belt, m."""


def crossings(path: Path) -> list[tuple[int, int]]:
    """Pairs of crossing spans.

    Parameters
    ----------
    path : Path

    Returns
    -------
    list of tuple
        Numbers of two spans, the smaller first.
    """
    starts, directions, lengths = path.span_points[:, 0], path.span_directions, path.span_lengths
    between = starts - starts[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # of parallel spans
        sine = _cross(directions[:, None], directions)
        along, across = _cross(between, directions) / sine, _cross(between, directions[:, None]) / sine
        meet = (along > 0.0) & (along < lengths[:, None]) & (across > 0.0) & (across < lengths)
    return [(one, other) for one, other in np.argwhere(np.triu(meet & (sine != 0.0), 1)).tolist()]


def obstacle(path: Path, around: Surroundings) -> Obstacle | None:
    """Find a pulley, or belt on it, that a span or an arc on another pulley collides with.

    Parameters
    ----------
    path : Path
    around : Surroundings

    Returns
    -------
    Obstacle or None
        The first that is found.
    """
    between = path.centers - path.centers[:, None]
    covered = _covers(path, -between).T
    reach = _extents(path, around, -between)
    hit = covered & (np.linalg.norm(between, axis=-1) < reach + reach.T)
    np.fill_diagonal(hit, False)
    for arc, pulley in np.argwhere(hit).tolist():
        return Obstacle("arc", arc, pulley)
    nearest, facing = _from_spans(path, around, path.centers)
    hit = np.linalg.norm(nearest, axis=-1) < _extents(path, around, -nearest) + facing
    for span, pulley in np.argwhere(hit).tolist():
        if pulley not in (span, (span + 1) % path.spans):
            return Obstacle("span", span, pulley)
    return None


def distance_from_belt(path: Path, around: Surroundings, center: ArrayLike, radius: float) -> float:
    """Least distance of a round part from the surfaces of the belt, m; negative for an overlap.

    Parameters
    ----------
    path : Path
    around : Surroundings
    center : array_like, shape (2,)
        Center of the part, m.
    radius : float
        Its radius, m.
    """
    place = np.asarray(center, dtype=float)
    nearest, facing = _from_spans(path, around, place[None])
    from_spans = np.linalg.norm(nearest, axis=-1) - facing
    between = place - path.centers
    above = np.linalg.norm(between, axis=-1) - np.abs(path.radii)
    outwards = (above > 0.0) == (path.radii > 0.0)
    from_arcs = np.abs(above) - np.where(outwards, around.back, around.inside)
    return float(min([*from_spans.ravel(), *from_arcs[_covers(path, between)]])) - radius


def _from_spans(path: Path, around: Surroundings, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ways to places from the nearest points of spans, and how far off the surface is that faces them, m.

    Shapes are (spans, places, 2) and (spans, places).
    """
    across, directions = places - path.span_points[:, None, 0], path.span_directions[:, None]
    along = np.clip(np.sum(across * directions, axis=-1), 0.0, path.span_lengths[:, None])
    facing = np.where(_cross(directions, across) > 0.0, around.inside, around.back)
    return across - along[..., None] * directions, facing


def _extents(path: Path, around: Surroundings, directions: FloatArray) -> FloatArray:
    """How far pulleys reach in directions, with the belt on them where it lies there, m; shapes as for `_covers`."""
    with_belt = np.abs(path.radii) + np.where(path.radii > 0.0, around.back, around.inside)
    return np.where(_covers(path, directions), with_belt, around.radii)


def _covers(path: Path, directions: FloatArray) -> BoolArray:
    """Tell whether belt lies on pulleys in directions from their centers, shape (..., n, 2)."""
    enters = np.roll(path.span_points[:, 1], 1, axis=0)[: path.count] - path.centers
    angle = np.sign(path.radii) * np.arctan2(_cross(enters, directions), np.sum(enters * directions, axis=-1))
    return np.asarray(angle % (2.0 * np.pi) <= path.wrap_angles)


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])

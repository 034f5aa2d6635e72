"""The path of the tension line around the pulleys, without penetration."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import BoolArray, FloatArray, IntArray

_ANGLE_TOLERANCE = 1e-12
"""Negative turning angle, rad, down to which it counts as zero: rounding must not make almost a full turn of it."""
_STRAIGHT = 1e-3
"""Bend of the path, rad, below which no side of a pulley is beyond its arc."""
_LENGTH_TOLERANCE = 1e-6
"""Relative difference of spans up to which they count as equally long, so that rounding does not choose between
them."""


@dataclass(frozen=True, eq=False)
class Path:
    """A path of straight spans and circular arcs, closed and counter-clockwise, or open between two ends.

    Of the pulleys on the path, span i leaves number i and reaches number i + 1; the last span reaches the first. Arc
    lengths of a closed path start with zero where the belt leaves the first pulley, and follow span 0, the arc of the
    second pulley, span 1, and so on to the arc of the first. An open path has a span more: the last but one leaves the
    last pulley for the second end, and the last comes from the first end. Its arc lengths start there. A pulley with
    the belt around its outside has a positive radius; a negative radius means that the pulley turns clockwise.

    Parameters
    ----------
    centers : ndarray, shape (n, 2), m
        Centers of the pulleys in the order in which the belt meets them.
    radii : ndarray, shape (n,), m
        Signed radii.
    ends : ndarray, shape (2, 2), m, optional
        Where an open path begins and where it ends; none for a closed path.
    nips : tuple of (int, int)
        Rollers beside the path, each with the pulley against which it presses the belt. Such a roller has neither wrap
        nor spans of its own.

    Raises
    ------
    ValueError
        If two successive pulleys have no common tangent because one contains or intersects the other.

    Examples
    --------
    >>> import numpy as np
    >>> two = bd.model.Path(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([0.1, 0.1]))
    >>> round(two.length, 4)  # two spans of a metre, and a circle
    2.6283
    """

    centers: FloatArray
    radii: FloatArray
    ends: FloatArray | None = None
    nips: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        centers, radii = _circles(self.centers[self.on], self.radii[self.on], self.ends)
        with np.errstate(under="ignore"):  # of centers that rounding sets apart
            distance = np.linalg.norm(_next(centers, -2) - centers, axis=1)
        apart = distance <= np.abs(_next(radii, -1) - radii)
        if np.any(_of_belt(apart, self.ends, axis=0)):
            raise ValueError("two successive pulleys have no common tangent")

    @property
    def count(self) -> int:
        """Number n of pulleys."""
        return len(self.radii)

    @property
    def beside(self) -> tuple[int, ...]:
        """Numbers of the rollers beside the path."""
        return tuple(roller for roller, _ in self.nips)

    @cached_property
    def on(self) -> IntArray:
        """Numbers of the pulleys on the path."""
        return _on_path(self.count, self.beside)

    @property
    def nips_by_roller(self) -> list[tuple[int, int]]:
        """Pairs of the nips in the order of their rollers, which is that of results."""
        return sorted(self.nips)

    def yielding(self, pulley: int) -> FloatArray:
        """Direction in which a tensioner pushes a pulley, shape (2,): the gradient of the length of the path.

        The roller of a nip, of which that length is independent, is pushed towards its pulley.
        """
        against = dict(self.nips).get(pulley)
        if against is None:
            return self.gradient(pulley)
        way = self.centers[against] - self.centers[pulley]
        return np.asarray(way / np.hypot(*way))

    @cached_property
    def indentations(self) -> FloatArray:
        """By how much each roller of a nip and its pulley overlap with the belt between them, m, shape (nips,)."""
        rollers, pulleys = np.array(self.nips, dtype=np.int64).reshape(-1, 2).T
        apart = np.linalg.norm(self.centers[rollers] - self.centers[pulleys], axis=1)
        return np.asarray(np.abs(self.radii[rollers]) + np.abs(self.radii[pulleys]) - apart)

    @cached_property
    def nip_angles(self) -> FloatArray:
        """Angle on its pulley from where the belt reaches it to the middle of each nip, rad, shape (nips,)."""
        rollers, pulleys = np.array(self.nips, dtype=np.int64).reshape(-1, 2).T
        way = self.centers[rollers] - self.centers[pulleys]
        enters = self.span_points[self.reaching[pulleys], 1] - self.centers[pulleys]
        turned = np.arctan2(_cross(enters, way), np.sum(enters * way, axis=1)) * np.sign(self.radii[pulleys])
        return np.asarray(np.where(turned > -_ANGLE_TOLERANCE, np.maximum(turned, 0.0), turned + 2 * np.pi))

    @property
    def shape(self) -> tuple[FloatArray, FloatArray | None, tuple[int, ...]]:
        """What `span_directions` and `span_points` take beside centers, and `wrap_angles` beside directions."""
        return self.radii, self.ends, self.beside

    @property
    def spans(self) -> int:
        """Number of spans: as many as pulleys on the path, or one more of an open path."""
        return len(self.on) + (self.ends is not None)

    @cached_property
    def reaching(self) -> IntArray:
        """Number of the span that reaches each pulley, shape (n,); of a roller beside the path, that before it."""
        return spans_at(*self.shape)[0]

    @cached_property
    def leaving(self) -> IntArray:
        """Number of the span that leaves each pulley, shape (n,); of a roller beside the path, that before it."""
        return spans_at(*self.shape)[1]

    @cached_property
    def span_pulleys(self) -> IntArray:
        """Numbers of the pulleys that each span leaves and reaches, shape (spans, 2), -1 for ends of the path."""
        leaves = self.on if self.ends is None else np.append(self.on, -1)
        return np.stack([leaves, np.roll(leaves, -1)], axis=1)

    @cached_property
    def span_directions(self) -> FloatArray:
        """Unit vectors u along the spans, shape (spans, 2)."""
        return span_directions(self.centers, self.radii, self.ends, self.beside)

    @cached_property
    def span_points(self) -> FloatArray:
        """Start and end point of each span, shape (spans, 2, 2), m: tangent points on pulleys, or ends of the path."""
        return span_points(self.centers, self.radii, self.ends, self.beside)

    @cached_property
    def span_lengths(self) -> FloatArray:
        """Lengths of the spans, shape (spans,), m."""
        return np.asarray(np.linalg.norm(self.span_points[:, 1] - self.span_points[:, 0], axis=1))

    @cached_property
    def wrap_angles(self) -> FloatArray:
        """Wrap angles, shape (n,), rad, from 0 to 2 pi."""
        return wrap_angles(self.span_directions, *self.shape)

    @property
    def total_turning(self) -> float:
        """Total rotation of the tangent, rad: 2 pi for a closed path without loops."""
        return float(np.sum(self.wrap_angles * np.sign(self.radii)))

    @property
    def ways_out(self) -> FloatArray:
        """Outward unit vectors at the ends of an open path, shape (2, 2)."""
        return np.array([-self.span_directions[-1], self.span_directions[-2]])

    @property
    def length(self) -> float:
        """Length of the path, m."""
        return float(self._starts[-1])

    def gradient(self, pulley: int) -> FloatArray:
        """Derivative of the length with respect to the center of a pulley.

        It is u_in - u_out, the unit vectors along the spans before and behind the pulley; arcs do not contribute, since
        the path is the shortest one.

        Parameters
        ----------
        pulley : int
            Number of the pulley.

        Returns
        -------
        ndarray, shape (2,)
        """
        return np.asarray(self.span_directions[self.reaching[pulley]] - self.span_directions[self.leaving[pulley]])

    @cached_property
    def order(self) -> IntArray:
        """Numbers of the spans in the order of arc lengths, shape (spans,)."""
        first = 0 if self.ends is None else self.spans - 1
        return (np.arange(self.spans) + first) % self.spans

    @cached_property
    def _starts(self) -> FloatArray:
        """Arc lengths where the pieces start, and the total, shape (2 spans + 1,).

        A span is followed by the arc behind it, which has no length behind the last span of an open path.
        """
        arcs = np.zeros(self.spans)
        arcs[: len(self.on)] = (self.wrap_angles * np.abs(self.radii))[self.on]
        pieces = np.stack([self.span_lengths, _next(arcs, -1)], axis=1)[self.order].ravel()
        return np.concatenate([[0.0], np.cumsum(pieces)])

    def span_start(self, span: int) -> float:
        """Arc length at the start of a span, m."""
        return float(self._starts[2 * int(np.flatnonzero(self.order == span)[0])])

    def arc_start(self, pulley: int) -> float:
        """Arc length where the belt reaches a pulley, m."""
        span = int(self.reaching[pulley])
        return self.span_start(span) + float(self.span_lengths[span])

    def clear_way(self, number: int) -> tuple[float, float] | None:
        """The direction from a pulley in which no span runs, where its name has room; None where the path is straight.

        It is that beyond its arc, and in a loop within a pulley on the back.
        """
        bend = self.gradient(number)
        size = float(np.linalg.norm(bend))
        if not size > _STRAIGHT:
            return None
        inward = self.ends is None and self.radii[number] < 0
        right, up = (bend / (-size if inward else size)).tolist()
        return right, up

    @property
    def longest_span(self) -> int:
        """Number of the longest span: the first of them, also where rounding tells them apart."""
        lengths = self.span_lengths
        return int(np.argmax(lengths >= (1.0 - _LENGTH_TOLERANCE) * lengths.max()))

    def position(self, s: ArrayLike) -> FloatArray:
        """Points on the path.

        Parameters
        ----------
        s : array_like, shape (k,), m
            Arc lengths, periodic in the length of a closed path.

        Returns
        -------
        ndarray, shape (k, 2), m
        """
        return self._trace(s)[0]

    def tangent(self, s: ArrayLike) -> FloatArray:
        """Unit tangents along the path, in running direction.

        Parameters
        ----------
        s : array_like, shape (k,), m
            Arc lengths, periodic in the length of a closed path.

        Returns
        -------
        ndarray, shape (k, 2)
        """
        return self._trace(s)[1]

    def bend(self, s: ArrayLike) -> FloatArray:
        """Curvature vector, the derivative of the tangent: zero on spans.

        Parameters
        ----------
        s : array_like, shape (k,), m
            Arc lengths, periodic in the length of a closed path.

        Returns
        -------
        ndarray, shape (k, 2), 1/m
        """
        return self._trace(s)[2]

    def _trace(self, s: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Points, tangents and their rates: a piece starts at p with a tangent u and has the curvature 1/r or 0."""
        s = np.asarray(s, dtype=float)
        reduced = np.mod(s, self.length) if self.ends is None else np.clip(s, 0.0, self.length)
        pieces = 2 * self.spans - (self.ends is not None)
        piece = np.clip(np.searchsorted(self._starts, reduced, side="right") - 1, 0, pieces - 1)
        along = reduced - self._starts[piece]
        span, on_arc = self.order[piece // 2], piece % 2 == 1
        start = np.where(on_arc[:, None], self.span_points[span, 1], self.span_points[span, 0])
        forward = self.span_directions[span]
        radius = np.append(self.radii, 1.0)[self.span_pulleys[span, 1]]
        angle = np.where(on_arc, along / radius, 0.0)[:, None]
        cosine, sine = np.cos(angle), np.sin(angle)
        tangents = cosine * forward + sine * _left(forward)
        on_circle = start + radius[:, None] * (sine * forward + (1 - cosine) * _left(forward))
        on_line = start + along[:, None] * forward
        bends = np.where(on_arc, 1.0 / radius, 0.0)[:, None] * _left(tangents)
        return np.where(on_arc[:, None], on_circle, on_line), tangents, bends


def span_directions(
    centers: FloatArray, radii: FloatArray, ends: FloatArray | None = None, beside: Sequence[int] = ()
) -> FloatArray:
    """Unit vectors u along the spans of paths around the same pulleys, shape (..., spans, 2).

    With the left normal n of u, a tangent point is c - r n, so that n . (c_j - c_i) = r_j - r_i; radii are signed.
    """
    on = _on_path(len(radii), beside)
    return _of_belt(_directions(*_circles(centers[..., on, :], radii[on], ends)), ends, axis=-2)


def span_points(
    centers: FloatArray, radii: FloatArray, ends: FloatArray | None = None, beside: Sequence[int] = ()
) -> FloatArray:
    """End points of spans, shape (..., spans, 2, 2), m; arguments as for `span_directions`."""
    on = _on_path(len(radii), beside)
    centers, circles = _circles(centers[..., on, :], radii[on], ends)
    normals = _left(_directions(centers, circles))
    starts = centers - circles[:, None] * normals
    stops = _next(centers, -2) - _next(circles, -1)[:, None] * normals
    return _of_belt(np.stack([starts, stops], axis=-2), ends, axis=-3)


def spans_at(
    radii: FloatArray, ends: FloatArray | None = None, beside: Sequence[int] = ()
) -> tuple[IntArray, IntArray]:
    """Numbers of the spans that reach and leave each pulley, shape (n,); both are that before a roller beside the path.

    The pulleys beside are on the arc of another, between two spans that are told apart there alone.
    """
    count, spans = len(radii), len(radii) - len(beside) + (ends is not None)
    on = ~np.isin(np.arange(count), beside)
    leaving = (np.cumsum(on) - 1) % spans
    return np.where(on, (leaving - 1) % spans, leaving), leaving


def wrap_angles(
    directions: FloatArray, radii: FloatArray, ends: FloatArray | None = None, beside: Sequence[int] = ()
) -> FloatArray:
    """Wrap angles, shape (..., n), rad, from `span_directions`."""
    before, after = (directions[..., spans, :] for spans in spans_at(radii, ends, beside))
    sine = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    turning = np.arctan2(sine, np.sum(before * after, axis=-1)) * np.sign(radii)
    return np.asarray(np.where(turning > -_ANGLE_TOLERANCE, np.maximum(turning, 0.0), turning + 2 * np.pi))


def _on_path(count: int, beside: Sequence[int]) -> IntArray:
    """Numbers of the pulleys on the path."""
    return np.setdiff1d(np.arange(count), beside)


def _circles(centers: FloatArray, radii: FloatArray, ends: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """Circles that follow each other in a round: the pulleys, then the second and the first end with radius zero."""
    if ends is None:
        return centers, radii
    points = np.broadcast_to(ends[::-1], (*centers.shape[:-2], 2, 2))
    return np.concatenate([centers, points], axis=-2), np.concatenate([radii, np.zeros(2)])


def _of_belt(values: NDArray[Any], ends: FloatArray | None, axis: int) -> NDArray[Any]:
    """Values of spans without that from the second end to the first one, where there is no belt."""
    return values if ends is None else np.delete(values, -2, axis)


@np.errstate(under="ignore")  # of centers that rounding sets apart
def _directions(centers: FloatArray, radii: FloatArray) -> FloatArray:
    """Unit vectors from each circle to the next, along the common tangent."""
    between = _next(centers, -2) - centers
    distance = np.maximum(np.linalg.norm(between, axis=-1, keepdims=True), np.finfo(float).tiny)
    along = between / distance
    sine = (_next(radii, -1) - radii)[:, None] / distance
    return np.asarray(np.sqrt(1 - sine**2) * along - sine * _left(along))


def _next(values: FloatArray, axis: int) -> FloatArray:
    """What the next one in the round has, along the last axis or the one before: a quicker numpy.roll."""
    last = axis == -1
    first, others = (values[..., :1], values[..., 1:]) if last else (values[..., :1, :], values[..., 1:, :])
    return np.concatenate([others, first], axis=axis)


def _left(vectors: FloatArray) -> FloatArray:
    """Left normals of vectors, shape (..., 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)


# Collisions of a path with itself, with pulleys and with the belt on them


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
    """Pairs of crossing spans."""
    starts, directions, lengths = path.span_points[:, 0], path.span_directions, path.span_lengths
    between = starts - starts[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # of parallel spans
        sine = _cross(directions[:, None], directions)
        along, across = _cross(between, directions) / sine, _cross(between, directions[:, None]) / sine
        meet = (along > 0.0) & (along < lengths[:, None]) & (across > 0.0) & (across < lengths)
    return [(one, other) for one, other in np.argwhere(np.triu(meet & (sine != 0.0), 1)).tolist()]


def obstacle(path: Path, around: Surroundings) -> Obstacle | None:
    """Find a pulley, or belt on it, that a span or an arc on another pulley collides with."""
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
        if pulley not in path.span_pulleys[span]:
            return Obstacle("span", span, pulley)
    return None


def distance_from_belt(path: Path, around: Surroundings, center: ArrayLike, radius: float) -> float:
    """Least distance of a round part from the surfaces of the belt, m; negative for an overlap."""
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
    enters = path.span_points[path.reaching, 1] - path.centers
    angle = np.sign(path.radii) * np.arctan2(_cross(enters, directions), np.sum(enters * directions, axis=-1))
    return np.asarray(angle % (2.0 * np.pi) <= path.wrap_angles)


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])

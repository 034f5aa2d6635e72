"""The path that the belt's centerline takes around its pulleys, before it sinks into them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray

_ROUNDING = 1e-12  # rad: a turning angle this far below zero is zero


@dataclass(frozen=True, eq=False)
class Path:
    """A closed path of straight spans and circular arcs, run counter-clockwise.

    Span i leaves pulley i and reaches pulley i + 1 (the last one reaches pulley 0). Arc lengths start with
    zero where the belt leaves pulley 0, and follow span 0, the arc of pulley 1, span 1, and so on to the arc of
    pulley 0. A pulley with the belt around its outside has a positive radius; a negative radius means that the
    pulley turns clockwise.

    Parameters
    ----------
    centers : ndarray, shape (n, 2), m
        Centers of the pulleys in the order in which the belt meets them.
    radii : ndarray, shape (n,), m
        Signed radii.

    Raises
    ------
    ValueError
        If no straight line touches two successive pulleys, because one holds or meets the other.
    """

    centers: FloatArray
    radii: FloatArray

    def __post_init__(self) -> None:
        distance = np.linalg.norm(np.roll(self.centers, -1, axis=0) - self.centers, axis=1)
        if np.any(distance <= np.abs(np.roll(self.radii, -1) - self.radii)):
            raise ValueError("two successive pulleys have no common tangent")

    @property
    def count(self) -> int:
        """Number n of pulleys, which is the number of spans."""
        return len(self.radii)

    @cached_property
    def span_directions(self) -> FloatArray:
        """Unit vectors u along the spans, shape (n, 2)."""
        return span_directions(self.centers, self.radii)

    @cached_property
    def span_points(self) -> FloatArray:
        """Start and end point of each span, shape (n, 2, 2), m: the tangent points on its two pulleys."""
        return span_points(self.centers, self.radii)

    @cached_property
    def span_lengths(self) -> FloatArray:
        """Lengths of the spans, shape (n,), m."""
        return np.asarray(np.linalg.norm(self.span_points[:, 1] - self.span_points[:, 0], axis=1))

    @cached_property
    def wrap_angles(self) -> FloatArray:
        """Angles over which the belt touches each pulley, shape (n,), rad, from 0 to 2 pi."""
        return wrap_angles(self.span_directions, self.radii)

    @property
    def total_turning(self) -> float:
        """Angle through which the tangent turns in one round, rad: 2 pi for a path without loops."""
        return float(np.sum(self.wrap_angles * np.sign(self.radii)))

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
        return np.asarray(self.span_directions[pulley - 1] - self.span_directions[pulley])

    @cached_property
    def _starts(self) -> FloatArray:
        """Arc lengths where the pieces start, and the total, shape (2 n + 1,): span 0, arc 1, span 1, ..., arc 0."""
        arcs = np.roll(self.wrap_angles * np.abs(self.radii), -1)
        pieces = np.stack([self.span_lengths, arcs], axis=1).ravel()
        return np.concatenate([[0.0], np.cumsum(pieces)])

    def position(self, s: ArrayLike) -> FloatArray:
        """Points on the path.

        Parameters
        ----------
        s : array_like, shape (k,), m
            Arc lengths, periodic in the length of the path.

        Returns
        -------
        ndarray, shape (k, 2), m
        """
        return self._trace(s)[0]

    def tangent(self, s: ArrayLike) -> FloatArray:
        """Point along the path at unit length, in the direction of motion.

        Parameters
        ----------
        s : array_like, shape (k,), m
            Arc lengths, periodic in the length of the path.

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
            Arc lengths, periodic in the length of the path.

        Returns
        -------
        ndarray, shape (k, 2), 1/m
        """
        return self._trace(s)[2]

    def _trace(self, s: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Points, tangents and their rates: a piece starts at p with a tangent u and has the curvature 1/r or 0."""
        reduced = np.mod(np.asarray(s, dtype=float), self.length)
        piece = np.clip(np.searchsorted(self._starts, reduced, side="right") - 1, 0, 2 * self.count - 1)
        along = reduced - self._starts[piece]
        span, on_arc = piece // 2, piece % 2 == 1
        start = np.where(on_arc[:, None], self.span_points[span, 1], self.span_points[span, 0])
        forward = self.span_directions[span]
        radius = np.roll(self.radii, -1)[span]
        angle = np.where(on_arc, along / radius, 0.0)[:, None]
        cosine, sine = np.cos(angle), np.sin(angle)
        tangents = cosine * forward + sine * _left(forward)
        on_circle = start + radius[:, None] * (sine * forward + (1 - cosine) * _left(forward))
        on_line = start + along[:, None] * forward
        bends = np.where(on_arc, 1.0 / radius, 0.0)[:, None] * _left(tangents)
        return np.where(on_arc[:, None], on_circle, on_line), tangents, bends


def span_directions(centers: FloatArray, radii: FloatArray) -> FloatArray:
    """Unit vectors u along the spans of paths around the same pulleys, shape (..., n, 2).

    With the left normal n of u, a tangent point is c - r n, so that n . (c_j - c_i) = r_j - r_i.

    Parameters
    ----------
    centers : ndarray, shape (..., n, 2), m
        Centers of the pulleys.
    radii : ndarray, shape (n,), m
        Signed radii.
    """
    between = np.roll(centers, -1, axis=-2) - centers
    distance = np.linalg.norm(between, axis=-1, keepdims=True)
    along = between / distance
    sine = (np.roll(radii, -1) - radii)[:, None] / distance
    return np.asarray(np.sqrt(1 - sine**2) * along - sine * _left(along))


def span_points(centers: FloatArray, radii: FloatArray) -> FloatArray:
    """Tangent points where spans start and end, shape (..., n, 2, 2), m; arguments as for `span_directions`."""
    normals = _left(span_directions(centers, radii))
    starts = centers - radii[:, None] * normals
    ends = np.roll(centers, -1, axis=-2) - np.roll(radii, -1)[:, None] * normals
    return np.stack([starts, ends], axis=-2)


def wrap_angles(directions: FloatArray, radii: FloatArray) -> FloatArray:
    """Angles over which belts touch each pulley, shape (..., n), rad, from `span_directions`."""
    before, after = np.roll(directions, 1, axis=-2), directions
    sine = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    turning = np.arctan2(sine, np.sum(before * after, axis=-1)) * np.sign(radii)
    return np.asarray(np.where(turning > -_ROUNDING, np.maximum(turning, 0.0), turning + 2 * np.pi))


def _left(vectors: FloatArray) -> FloatArray:
    """Left normals of vectors, shape (..., 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)

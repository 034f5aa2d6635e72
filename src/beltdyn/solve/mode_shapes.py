"""Shapes of small motions: how belt, pulleys and tensioners move in a mode, and where its kinetic energy is."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.quadrature import gauss_points
from beltdyn.solve.small_motions import SmallMotions
from beltdyn.solve.staying import depths
from beltdyn.system.centreline import centreline_points
from beltdyn.system.constant_drive import rim_of_bodies

_POINTS = 6
"""Gauss points of an element."""
_MOST = 0.7
"""Share of the energy from which on a mode is one of spans, of rotation, or of tensioners, and not coupled."""
_NAMED = 0.15
"""Share of the energy from which on a part is named."""
KINDS = ("span", "rotational", "tensioner")


class Points(NamedTuple):
    """Points of the belt."""

    along: FloatArray
    """Belt coordinates, m, shape (q,)."""
    weight: FloatArray
    """Mass that belongs to each, kg."""
    place: FloatArray
    """m, shape (q, 2)."""
    slope: FloatArray
    """dr/dx, shape (q, 2)."""
    span: IntArray
    """Number of the span in which each is, or of that behind the pulley that it touches."""

    @property
    def tangent(self) -> FloatArray:
        """Unit vectors along the belt, shape (q, 2)."""
        return np.asarray(self.slope / np.linalg.norm(self.slope, axis=1)[:, None])

    @property
    def normal(self) -> FloatArray:
        """Unit vectors to the left of it, shape (q, 2)."""
        along = self.tangent
        return np.column_stack([-along[:, 1], along[:, 0]])


class Shapes(NamedTuple):
    """How parts move in each of k modes; of belt, rims and tensioned pulleys the largest amplitude is 1."""

    belt: ComplexArray
    """Across the belt, to the left, shape (k, q)."""
    rims: ComplexArray
    """Ways of the rims, counter-clockwise, shape (k, P)."""
    tensioners: ComplexArray
    """Ways of the centres, positive where the path gets longer, shape (k, K)."""
    span_share: FloatArray
    """Of the kinetic energy, the motion of the belt across, shape (k, P)."""
    pulley_share: FloatArray
    """Of the kinetic energy, rotation of the pulley and its hub, shape (k, P)."""
    belt_share: FloatArray
    """Of the kinetic energy, the motion of the belt along itself, shape (k,)."""
    tensioner_share: FloatArray
    """Of the kinetic energy, shape (k, K)."""


def belt_points(motions: SmallMotions) -> Points:
    """Gauss points of the belt in the state about which it moves."""
    system, quadrature = motions.system, gauss_points(_POINTS)
    starts = np.cumsum(system.length) - system.length
    along = (starts[:, None] + np.outer(system.length, quadrature.points)).ravel()
    weight = motions.drive.belt.mass_per_length * np.outer(system.length, quadrature.weights).ravel()
    place, slope, _ = centreline_points(system, motions.state.position, along)
    deep = depths(system, motions.state, place)
    touched = np.where(deep.max(axis=0) >= 0.0, deep.argmax(axis=0), -1)
    last = np.maximum.accumulate(np.where(touched >= 0, np.arange(touched.size), -1))
    return Points(along, weight, place, slope, np.where(last >= 0, touched[last], touched[touched >= 0][-1]))


def shapes_of(motions: SmallMotions, points: Points, values: ComplexArray, coordinates: ComplexArray) -> Shapes:
    """How parts move in modes.

    Parameters
    ----------
    motions
        The drive about a state.
    points
        Where to look at the belt.
    values : ndarray, shape (k,)
        Eigenvalues, 1/s.
    coordinates : ndarray, shape (n, k)
        Unknowns of the eigenvectors.
    """
    found = [_shape(motions, points, value, vector) for value, vector in zip(values, coordinates.T, strict=True)]
    return Shapes(*map(np.array, zip(*found, strict=True)))


def _shape(motions: SmallMotions, points: Points, value: complex, vector: ComplexArray) -> tuple[object, ...]:
    """Fields of `Shapes` of one mode."""
    system, bodies = motions.system, motions.bodies
    count, pulleys = bodies.size - system.tensioners.size, system.pulleys.size
    way = np.where(bodies >= 0, vector[bodies], 0.0)
    passed, arms = way[count - 1], way[count:]
    moved, turned = _of_points(motions, points, vector)
    speed = motions.state.velocity[system.frame.place]
    velocity = value * (moved + passed * points.slope) + speed * turned
    across = np.sum(moved * points.normal, axis=1)
    rims = way[:pulleys] * system.rims.radius
    reached = arms * np.asarray(system.bodies.reach)[count:]
    parts = np.concatenate([across, rims, reached])
    scale = parts[np.argmax(np.abs(parts))]
    inertia = np.asarray(system.bodies.kinetic) * np.abs(value * way) ** 2
    of_pulley = rim_of_bodies(system)
    rotation = np.array([inertia[:count][of_pulley == number].sum() for number in range(pulleys)])
    crosswise, lengthwise = (
        points.weight * np.abs(np.sum(velocity * direction, axis=1)) ** 2
        for direction in (points.normal, points.tangent)
    )
    spans = np.bincount(points.span, crosswise, pulleys)
    total = spans.sum() + rotation.sum() + lengthwise.sum() + inertia[count:].sum()
    shares = spans / total, rotation / total, lengthwise.sum() / total, inertia[count:] / total
    return across / scale, rims / scale, reached / scale, *shares


def _of_points(motions: SmallMotions, points: Points, vector: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Displacements of points of the mesh and their derivatives along the belt, shape (q, 2)."""
    parts = [centreline_points(motions.system, part, points.along)[:2] for part in (vector.real, vector.imag)]
    real, imaginary = parts
    return real[0] + 1j * imaginary[0], real[1] + 1j * imaginary[1]


def kind_of_mode(shapes: Shapes, number: int) -> str:
    """What moves most: "span", "rotational" (pulleys with the belt along itself), "tensioner", or "coupled"."""
    rotation = shapes.pulley_share[number].sum() + shapes.belt_share[number]
    groups = shapes.span_share[number].sum(), rotation, shapes.tensioner_share[number].sum()
    largest = int(np.argmax(groups))
    return KINDS[largest] if groups[largest] >= _MOST else "coupled"


def parts_of_mode(shapes: Shapes, number: int, spans: list[str], pulleys: list[str], tensioners: list[str]) -> str:
    """Names of the parts that have most of the energy, those with more first.

    Parameters
    ----------
    shapes, number
        The mode.
    spans, pulleys, tensioners
        Names of the parts.
    """
    shares = np.concatenate([shapes.span_share[number], shapes.pulley_share[number], shapes.tensioner_share[number]])
    names = [*spans, *pulleys, *(f"arm of {one}" for one in tensioners)]
    order = [int(one) for one in np.argsort(-shares) if shares[one] >= _NAMED]
    return ", ".join(names[one] for one in order) or "belt"

"""Shapes of small motions: how belt, pulleys and tensioners move in a mode, and where its kinetic energy is."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import schedule_value
from beltdyn.model import Drive
from beltdyn.model.carrying import in_batch, lies_on
from beltdyn.quadrature import gauss_points
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.staying import depths
from beltdyn.system.arc_mesh import passed_at
from beltdyn.system.arrays import Carrying
from beltdyn.system.constant_drive import rim_of_bodies
from beltdyn.system.frame import centreline_points
from beltdyn.system.moving_center import pulley_centers

_POINTS = 6
"""Gauss points of an element."""
_MOST = 0.7
"""Share of the energy from which on a mode is one of spans, of rotation, or of tensioners, and not coupled."""
_NAMED = 0.15
"""Share of the energy from which on a part is named."""
KINDS = ("span", "rotational", "tensioner")
_EVEN = 600
"""Points at which motions of belts on different meshes are compared."""


class Points(NamedTuple):
    """Points of the belt."""

    along: FloatArray
    """Belt coordinates, m, shape (q,)."""
    weight: FloatArray
    """Mass of belt and goods that belongs to each, kg."""
    turning: FloatArray
    """Mass of idlers that moves along the belt with each, kg."""
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


class Shares(NamedTuple):
    """Parts of the kinetic energy, of each of k modes or of one; they add up to 1."""

    span: FloatArray
    """The motion of the belt across itself, shape (k, P)."""
    pulley: FloatArray
    """Rotation of the pulley and its hub, shape (k, P)."""
    belt: FloatArray
    """The motion of the belt along itself, shape (k,)."""
    tensioner: FloatArray
    """Shape (k, K)."""

    def of(self, number: int) -> "Shares":
        """Those of one mode."""
        return Shares(*(part[number] for part in self))

    @property
    def kind(self) -> str:
        """What moves most: "span", "rotational" (pulleys with the belt along itself), "tensioner", or "coupled"."""
        groups = self.span.sum(), self.pulley.sum() + self.belt, self.tensioner.sum()
        largest = int(np.argmax(groups))
        return KINDS[largest] if groups[largest] >= _MOST else "coupled"

    def parts(self, names: Sequence[str]) -> str:
        """Names of the parts that have most of the energy, those with more first; names are those of `part_names`."""
        shares = np.concatenate([self.span, self.pulley, self.tensioner])
        order = [int(one) for one in np.argsort(-shares) if shares[one] >= _NAMED]
        return ", ".join(names[one] for one in order) or "belt"


def part_names(drive: Drive) -> list[str]:
    """Names of spans, pulleys and tensioners."""
    arms = [f"arm of {one.pulley}" for one in drive.moving_tensioners]
    return ["-".join(span) for span in drive.spans] + [one.name for one in drive.pulleys] + arms


class Shapes(NamedTuple):
    """How parts move in each of k modes; of belt, rims and tensioned pulleys the largest amplitude is 1."""

    belt: ComplexArray
    """Across the belt, to the left, shape (k, q)."""
    rims: ComplexArray
    """Ways of the rims, counter-clockwise, shape (k, P)."""
    tensioners: ComplexArray
    """Ways of the centers, positive where the path gets longer, shape (k, K)."""


def belt_points(motions: SmallMotions) -> Points:
    """Gauss points of the belt in the state about which it moves."""
    system, quadrature = motions.system, gauss_points(_POINTS)
    starts = np.cumsum(system.length) - system.length
    along = (starts[:, None] + np.outer(system.length, quadrature.points)).ravel()
    place, slope, _ = centreline_points(system, motions.state.position, along)
    path = motions.prepared.path
    deep = depths(system, pulley_centers(system, motions.state.position), place)[path.on]
    touched = np.where(deep.max(axis=0) >= 0.0, deep.argmax(axis=0), -1)  # the span that leaves has the same number
    last = np.maximum.accumulate(np.where(touched >= 0, np.arange(touched.size), -1))
    before = touched[touched >= 0][-1] if path.ends is None else path.spans - 1
    span = np.where(last >= 0, touched[last], before)
    masses = _masses(motions, along, np.outer(system.length, quadrature.weights).ravel())
    return Points(along, *masses, place, slope, span)


def even_points(motions: SmallMotions) -> Points:
    """Points at equal distances along the belt, as many of any mesh, and at the same places of neighboring states.

    On a long belt none of them may lie on an arc, as Gauss points do.
    """
    system, fine = motions.system, belt_points(motions)
    distance = float(system.length.sum()) / _EVEN
    along = distance * (np.arange(_EVEN, dtype=float) + 0.5)
    place, slope, _ = centreline_points(system, motions.state.position, along)
    span = fine.span[np.maximum(np.searchsorted(fine.along, along, side="right") - 1, 0)]
    return Points(along, *_masses(motions, along, np.full(_EVEN, distance)), place, slope, span)


def _masses(motions: SmallMotions, along: FloatArray, length: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Masses of belt with goods, and of idlers, that belong to lengths (m) at places along the belt, kg."""
    prepared, system = motions.prepared, motions.system
    riding, turning = np.full(along.size, prepared.belt.mass_per_length), np.zeros(along.size)
    rows = system.carrying.goods if isinstance(system.carrying, Carrying) else ()
    for one, row in zip(prepared.goods, rows, strict=True):
        stretch, share = prepared.stretch(one), interpreted(schedule_value)(system.profiles, int(row.schedule), 0.0)
        here = lies_on(prepared.laid, stretch, along) & in_batch(prepared.laid, stretch, one, along)
        riding += one.mass_per_length * share * here
    for support in prepared.supports:
        turning += support.rotating_mass * lies_on(prepared.laid, prepared.stretch(support), along)
    return riding * length, turning * length


def shapes_of(motions: SmallMotions, points: Points, coordinates: ComplexArray) -> Shapes:
    """How parts move in modes."""
    return Shapes(*map(np.array, zip(*(_shape(motions, points, vector) for vector in coordinates.T), strict=True)))


def _shape(motions: SmallMotions, points: Points, vector: ComplexArray) -> tuple[ComplexArray, ...]:
    """Fields of `Shapes` of one mode."""
    system = motions.system
    shafts, arms = _ways_of_bodies(motions, vector)
    across = np.sum(_of_points(motions, points, vector)[0] * points.normal, axis=1)
    rims = shafts[: system.pulleys.size] * system.rims.radius
    reached = arms * np.asarray(system.bodies.reach)[shafts.size :]
    parts = np.concatenate([across, rims, reached])
    scale = parts[np.argmax(np.abs(parts))]
    return across / scale, rims / scale, reached / scale


def speeds_of(motions: SmallMotions, points: Points, value: complex, vector: ComplexArray) -> tuple[ComplexArray, ...]:
    """Amplitudes of speeds in a mode, each times the root of its mass: their squares are twice the kinetic energy.

    Across and along the belt at its points, of shafts (rims, hub bodies and the passage of the belt, which has no
    inertia of its own), and of tensioner arms.
    """
    system = motions.system
    shafts, arms = _ways_of_bodies(motions, vector)
    moved, turned = _of_points(motions, points, vector)
    passed, speed = passed_at(system, shafts, points.along), motions.state.velocity[system.frame.place]
    velocity = value * (moved + passed[:, None] * points.slope) + speed * turned
    inertia = np.sqrt(np.asarray(system.bodies.kinetic))
    across = np.sqrt(points.weight) * np.sum(velocity * points.normal, axis=1)
    along = np.sqrt(points.weight + points.turning) * np.sum(velocity * points.tangent, axis=1)
    return across, along, inertia[: shafts.size] * value * shafts, inertia[shafts.size :] * value * arms


def shares_of(motions: SmallMotions, points: Points, values: ComplexArray, coordinates: ComplexArray) -> Shares:
    """Where the kinetic energy of modes is; parameters as for `speeds_of`, of k eigenvalues."""
    found = [_share(motions, points, value, vector) for value, vector in zip(values, coordinates.T, strict=True)]
    return Shares(*map(np.array, zip(*found, strict=True)))


def _share(motions: SmallMotions, points: Points, value: complex, vector: ComplexArray) -> tuple[object, ...]:
    """Fields of `Shares` of one mode."""
    pulleys = motions.system.pulleys.size
    across, along, shafts, arms = (np.abs(part) ** 2 for part in speeds_of(motions, points, value, vector))
    of_pulley = rim_of_bodies(motions.system)
    rotation = np.array([shafts[of_pulley == number].sum() for number in range(pulleys)])
    total = across.sum() + along.sum() + shafts.sum() + arms.sum()
    spans = np.bincount(points.span, across, motions.prepared.path.spans)
    return spans / total, rotation / total, along.sum() / total, arms / total


def _ways_of_bodies(motions: SmallMotions, vector: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Ways of shafts, shape (D - K,), and of tensioners, shape (K,)."""
    way = np.where(motions.bodies >= 0, vector[motions.bodies], 0.0)
    count = way.size - motions.system.tensioners.size
    return way[:count], way[count:]


def _of_points(motions: SmallMotions, points: Points, vector: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Displacements of points of the mesh and their derivatives along the belt, shape (q, 2)."""
    parts = [centreline_points(motions.system, part, points.along)[:2] for part in (vector.real, vector.imag)]
    real, imaginary = parts
    return real[0] + 1j * imaginary[0], real[1] + 1j * imaginary[1]

"""Formulas of belt drives on plain arrays, for the summary and for whatever is derived from a dataset.

Along the last axis lie pulleys, spans or contact points. Span i leaves pulley i and reaches pulley i + 1; the
last one reaches pulley 0.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.contact.contact_zone import BINOMIALS
from beltdyn.contact.friction.law import saturation_at
from beltdyn.elements import ELEMENTS, ElementKind
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.model.resolution import shifts_at_nodes

if TYPE_CHECKING:
    import xarray as xr

# Places on the arcs of pulleys, from circles alone


def arc_ends(prepared: Prepared, centers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles from the x axis at which the belt reaches pulleys, and wrap angles; shape (..., pulleys), rad."""
    shape = prepared.path.shape
    reached = span_points(centers, *shape)[..., prepared.path.reaching, 1, :] - centers
    return np.arctan2(reached[..., 1], reached[..., 0]), wrap_angles(span_directions(centers, *shape), *shape)


def wraps_of_contact(prepared: Prepared, centers: FloatArray, contact: FloatArray) -> FloatArray:
    """Wrap angles from the angles of contact at centers, rad, shape (..., pulleys): at most those of straight spans.

    A strand crosses the rim before it has sunk in, by acos(1 - d / R) at either end of the arc. In nips the angles of
    contact stay.
    """
    shape, geometry = prepared.path.shape, np.array(contact, dtype=float)
    on_path = np.setdiff1d(np.arange(geometry.shape[-1]), prepared.path.beside)
    straight = wrap_angles(span_directions(centers, *shape), *shape)
    geometry[..., on_path] = np.minimum(geometry, straight)[..., on_path]
    return geometry


def angle_from_inlet(place: FloatArray, inlet: ArrayLike, wrap: ArrayLike, turning: ArrayLike) -> FloatArray:
    """Angle of points around a pulley in the direction of ascending belt coordinate, rad; zero at the inlet.

    Points are taken from the pulley's center; `turning` is -1 for a pulley at the belt's back, else 1.
    """
    free = 0.5 * (2.0 * np.pi - np.asarray(wrap))
    turned = np.asarray(turning) * (np.arctan2(place[:, 1], place[:, 0]) - np.asarray(inlet))
    return np.asarray(np.mod(turned + free, 2.0 * np.pi) - free)


UNLOADED = 1e-4
"""Difference of the tensions at a pulley, over their sum, up to which it counts as unloaded."""


def rim_speeds(speed: FloatArray, prepared: Prepared) -> FloatArray:
    """Speeds at which a belt without tension rolls on the rims, in the direction of ascending belt coordinate, m/s."""
    turning = np.array([pulley.turning for pulley in prepared.pulleys])
    return np.asarray(speed * prepared.rolling_radii * turning)


def relative_loss(values: FloatArray, rim: FloatArray, reference: int) -> FloatArray:
    """Excess of values over that of the reference pulley, over its rim speed; NaN where it stands still."""
    against = slice(reference, reference + 1)
    lost, speed = values - values[..., against], rim[..., against]
    unknown = np.full(np.broadcast(lost, speed).shape, np.nan)
    return np.asarray(np.divide(lost, speed, out=unknown, where=speed != 0.0))


def across(spans: FloatArray, prepared: Prepared) -> tuple[FloatArray, FloatArray]:
    """Values of the spans before and after every pulley, in the direction of ascending belt coordinate."""
    return spans[..., prepared.path.reaching], spans[..., prepared.path.leaving]


Pair = tuple[FloatArray, FloatArray]
"""Values where the belt reaches and leaves every pulley, each of shape (..., pulleys)."""


class SpanTension(NamedTuple):
    """Tension over spans in the direction of ascending belt coordinate, N, each of shape (..., spans)."""

    start: FloatArray
    """Where the belt leaves a pulley."""
    end: FloatArray
    """Where it reaches the next one."""
    mean: FloatArray

    @classmethod
    def of(cls, value_of: Callable[[str], FloatArray]) -> "SpanTension":
        """From recorded variables, which `value_of` gives by name."""
        return cls(*(value_of(name) for name in ("span_tension_at_start", "span_tension_at_end", "span_tension")))

    @classmethod
    def uniform(cls, tension: FloatArray) -> "SpanTension":
        """The same all along each span."""
        return cls(tension, tension, tension)

    def each(self, change: Callable[[FloatArray], FloatArray]) -> "SpanTension":
        """Change all three alike."""
        return SpanTension(*map(change, self))

    def at_arcs(self, prepared: Prepared) -> Pair:
        """Tensions where the belt reaches and leaves every pulley, shape (..., pulleys)."""
        return self.end[..., prepared.path.reaching], self.start[..., prepared.path.leaving]


def cells(belt_coordinate: FloatArray, length: float) -> FloatArray:
    """Length of closed belt that belongs to each contact point, m: half of the way to its neighbors."""
    gaps = np.diff(belt_coordinate, append=belt_coordinate[0] + length)
    return np.asarray(0.5 * (gaps + np.roll(gaps, 1)))


def element_lengths(dataset: "xr.Dataset", belt_length: float) -> FloatArray:
    """Reference lengths of the elements of a result, m."""
    nodes = dataset["node_coordinate"].values
    return np.diff(nodes, append=nodes[0] + belt_length)[: dataset.sizes["element"]]


PASSED = "belt at "
"""Before the name of a pulley: what of the belt has passed there, among the bodies."""
MESH_BESIDE = ("mesh_before", "mesh_after", "mesh_share")
"""Attributes of runs on a mesh that stays at every arc: arguments of `shifts_at_nodes`."""


def present_lengths(instants: "xr.Dataset", belt_length: float) -> FloatArray:
    """Reference lengths of the elements at instants of a run, m, shape (..., elements): spans may become longer."""
    lengths = element_lengths(instants, belt_length)
    if not set(MESH_BESIDE) <= instants.attrs.keys():
        return lengths
    passed = instants["body_position"].values[..., instants["body"].str.startswith(PASSED).values]
    before, after, share = (np.asarray(instants.attrs[name]) for name in MESH_BESIDE)
    shifts = shifts_at_nodes(before, after, share, passed)
    return np.asarray(lengths - (np.roll(shifts, -1, axis=-1) - shifts)[..., : lengths.size])


def recorded_kind(dataset: "xr.Dataset", prepared: Prepared) -> ElementKind:
    """Give the kind of the elements whose nodal coordinates a result holds."""
    given, names = prepared.element_kind, tuple(dataset["coordinate"].values.tolist())
    return next(kind for kind in (given, *ELEMENTS.values()) if kind.coordinates == names)


def sliding_velocity(
    slip_velocity: FloatArray, normal: FloatArray, touched: IntArray, pulley_speed: FloatArray, prepared: Prepared
) -> FloatArray:
    """Slip velocity beyond creep; zero where the belt does not press on a pulley.

    It is sign(v_t) max(abs(v_t) - v_c, 0), with v_c the slip velocity at which friction reaches mu f_n; zero where
    teeth hold the belt. `touched` has pulley numbers, -1 where free.
    """
    pressed = (touched >= 0) & (normal > 0.0) & ~prepared.toothed[touched]
    law, rim = prepared.friction_parameters, pulley_speed * prepared.radii
    creep = saturation_at(law, pressed, touched, normal, prepared.frictions, rim)
    slip, beyond = slip_velocity[pressed], np.zeros(slip_velocity.shape)
    beyond[pressed] = slip - np.clip(slip, -creep, creep)
    return beyond


def sliding_shares(sliding: FloatArray, pressed: BoolArray, cell: FloatArray) -> FloatArray:
    """Part of every arc of contact on which the belt slides, shape (k, pulleys); zero without contact."""
    lengths = pressed @ cell
    slid = (pressed & (sliding != 0.0)[:, None]) @ cell
    return np.asarray(np.divide(slid, lengths, out=np.zeros_like(lengths), where=lengths > 0.0))


def pressing(normal: FloatArray, touched: IntArray, pulleys: int) -> BoolArray:
    """Where the belt presses on each pulley, shape (k, pulleys, points)."""
    return np.asarray((touched[:, None] == np.arange(pulleys)[:, None]) & (normal > 0.0)[:, None])


def gross_sliding(sliding: FloatArray, pressed: BoolArray, prepared: Prepared) -> FloatArray:
    """Velocity at which the belt slides on the whole arc of each pulley, shape (k, pulleys), m/s along the belt.

    The sliding velocity nearest to zero of all points that press; zero if one of them only creeps, or slides the other
    way. Positive where the belt is faster than the rim, in the direction of ascending belt coordinate.
    """
    lowest = np.where(pressed, sliding[:, None], np.inf).min(axis=-1)
    highest = np.where(pressed, sliding[:, None], -np.inf).max(axis=-1)
    turning = np.array([pulley.turning for pulley in prepared.pulleys])
    nearest = np.where(lowest > 0.0, lowest, np.minimum(highest, 0.0))
    return np.asarray(turning * np.where(np.any(pressed, axis=-1), nearest, 0.0))


# The belt's centerline as smooth curves, from nodal coordinates

POINTS = 17
"""Points drawn on an element, ends included."""


def centerline(kind: ElementKind, coordinates: FloatArray, lengths: FloatArray, points: int = POINTS) -> FloatArray:
    """Points on the Bezier curve that begins at each node, ends included, shape (nodes, points, 2), m."""
    xi = np.linspace(0.0, 1.0, points)
    curves = np.arange(len(lengths))
    places = curve_points(kind, coordinates, lengths, np.repeat(curves, points), np.tile(xi, len(curves)))
    return places.reshape(-1, points, 2)


def curve_points(
    kind: ElementKind, coordinates: FloatArray, lengths: FloatArray, curve: IntArray, xi: FloatArray
) -> FloatArray:
    """Points on the centerline, shape (..., points, 2), m: each at xi in [0, 1] on the curve of a node."""
    points = curve_controls(kind, coordinates, lengths)
    degree, along = points.shape[-2] - 1, xi[:, None]
    order = np.arange(degree + 1)
    weights = BINOMIALS[degree, order] * along**order * (1.0 - along) ** (degree - order)
    return np.asarray(np.einsum("kp,...kpa->...ka", weights, points[..., curve, :, :]))


def curve_controls(kind: ElementKind, coordinates: FloatArray, lengths: FloatArray) -> FloatArray:
    """Control points of the Bezier curves, shape (..., curves, degree + 1, 2), m; arguments as for `curve_points`."""
    instants = coordinates.shape[:-2]
    first = coordinates.reshape(*instants, -1, kind.dof)
    elements = lengths.shape[-1] // kind.points
    element = np.concatenate([first, np.roll(first, -1, axis=-2)], axis=-1)[..., :elements, :]
    vectors = np.stack([element[..., start : start + 2] for start in kind.vectors], axis=-2)
    control = kind.control(lengths.reshape(*lengths.shape[:-1], elements, -1).sum(axis=-1))
    points = np.einsum("...ncpv,...nva->...ncpa", control, vectors)
    return np.asarray(points.reshape(*instants, -1, control.shape[-2], 2))


def curvatures(kind: ElementKind, coordinates: FloatArray, lengths: FloatArray, xi: FloatArray) -> FloatArray:
    """Curvature of each curve at places xi in [0, 1], shape (..., curves, places), 1/m, positive to the left."""
    controls = curve_controls(kind, coordinates, lengths)
    degree, along = controls.shape[-2] - 1, xi[:, None]
    first, second = np.diff(controls, axis=-2) * degree, np.diff(controls, n=2, axis=-2) * degree * (degree - 1)
    slope, bend = (
        np.einsum("kp,...pa->...ka", BINOMIALS[top, order] * along**order * (1.0 - along) ** (top - order), vectors)
        for vectors, top, order in ((first, degree - 1, np.arange(degree)), (second, degree - 2, np.arange(degree - 1)))
    )
    cross = slope[..., 0] * bend[..., 1] - slope[..., 1] * bend[..., 0]
    return np.asarray(cross / np.sum(slope**2, axis=-1) ** 1.5)


def mean_curvature(kind: ElementKind, coordinates: FloatArray, lengths: FloatArray) -> FloatArray:
    """Mean curvature of each curve of a closed belt, shape (..., curves), 1/m, positive to the left.

    The turn of the tangent over the length. At a node without a common tangent, as between straight elements, the
    tangent halves the kink.
    """
    points = curve_controls(kind, coordinates, lengths)
    first, last = (_unit(points[..., after, :] - points[..., before, :]) for before, after in ((0, 1), (-2, -1)))
    tangent = first + np.roll(last, 1, axis=-2)
    after = np.roll(tangent, -1, axis=-2)
    cross = tangent[..., 0] * after[..., 1] - tangent[..., 1] * after[..., 0]
    turn = np.arctan2(cross, np.sum(tangent * after, axis=-1))
    chord = np.linalg.norm(points[..., -1, :] - points[..., 0, :], axis=-1)
    return np.asarray(turn * np.sinc(turn / (2.0 * np.pi)) / chord)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))

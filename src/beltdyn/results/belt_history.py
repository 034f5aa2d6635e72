"""Tension and curvature of material points of the belt: over a turn in steady running, and over time."""

from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.elements import ElementKind
from beltdyn.errors import ModelError
from beltdyn.kernel import kernel
from beltdyn.model import Prepared
from beltdyn.model.path import span_points
from beltdyn.quadrature import running_integral
from beltdyn.results.mechanics import curvatures, element_lengths, mean_curvature, recorded_kind
from beltdyn.results.run import Run

if TYPE_CHECKING:
    import xarray as xr


_SMOOTH_VECTORS = 6
"""Vectors of an element whose nodes share place, slope and curvature."""
PLACES = 8
"""Places of an element at which its curvature is taken, its first node among them, where arcs end and extremes lie."""
_STEPS = 2
"""Least number of instants in which a material point passes one element of mean length."""


class BeltHistory(NamedTuple):
    """What a material point of the belt meets."""

    passed: FloatArray
    """Length of unstretched belt that has passed, m, shape (k,)."""
    time: FloatArray
    """s, shape (k,)."""
    tension: FloatArray
    """Tension of the line of force, as of spans, N, shape (k, points)."""
    curvature: FloatArray
    """1/m, positive on pulleys inside the belt, shape (k, points)."""
    pulley: IntArray
    """Number of the nearest pulley, shape (k, points)."""


class _Fields(NamedTuple):
    """What is known at places along the belt at outputs, shapes (outputs, places)."""

    time: FloatArray
    """Shape (outputs,), s."""
    along: FloatArray
    """Places on the unstretched belt, ascending, m, shape (places,)."""
    tension: FloatArray
    curvature: FloatArray
    pulley: IntArray


def turn_history(run: Run) -> BeltHistory:
    """History of any material point over a turn of the belt in steady running, shape (places, 1)."""
    fields, prepared = _fields(run, slice(-1, None)), run.prepared
    speed = float(np.squeeze(run.dataset.attrs["belt_parameter"]))
    way = slice(None) if speed > 0.0 else slice(None, None, -1)
    passed = fields.along if speed > 0.0 else prepared.belt_length - fields.along[::-1]
    tension, curvature, pulley = fields.tension[0, way], fields.curvature[0, way], fields.pulley[0, way]
    return BeltHistory(passed, passed / abs(speed), tension[:, None], curvature[:, None], pulley[:, None])


def belt_history(run: Run, points: int = 8) -> BeltHistory:
    """Histories of equally spaced material points over a run.

    Between outputs along the belt, values change linearly in time as seen from the pulleys, while the belt passes.

    Parameters
    ----------
    run : Run
        A run over time of a closed belt.
    points : int, default 8
        Number of material points.
    """
    fields, prepared = _fields(run, slice(None)), run.prepared
    in_turn = max(fields.along.size, _STEPS * run.dataset.sizes["element"])
    if len(fields.time) < 2:
        raise ModelError("the run has one output along the belt, which is no history. Choose a shorter field_interval.")
    along, length = fields.along, prepared.belt_length
    passed = np.interp(fields.time, run.dataset["time"].values, _passed(run))
    marks, parts = np.arange(points) * length / points, list[BeltHistory]()
    for output in range(len(fields.time) - 1):
        way = passed[output : output + 2]
        steps = max(int(np.ceil(abs(way[1] - way[0]) / length * in_turn)), 1)
        part = np.arange(steps + (output == len(fields.time) - 2)) / steps
        now = way[0] + part * (way[1] - way[0])
        origin = np.zeros(2) if prepared.frame.stays else way
        before, after = (np.mod(now[:, None] - origin[side] + marks, length) for side in (0, 1))
        mixed = [
            (1.0 - part[:, None]) * np.interp(before, along, field[output], period=length)
            + part[:, None] * np.interp(after, along, field[output + 1], period=length)
            for field in (fields.tension, fields.curvature)
        ]
        nearest = fields.pulley[output][_nearest_place(along, length, before)]
        time = fields.time[output] + part * (fields.time[output + 1] - fields.time[output])
        parts.append(BeltHistory(now, time, mixed[0], mixed[1], nearest))
    passed, time, tension, curvature, pulley = map(np.concatenate, zip(*parts, strict=True))
    return BeltHistory(passed, time, tension, curvature, pulley)


def _nearest_place(along: FloatArray, length: float, places: FloatArray) -> IntArray:
    """Numbers of the nearest of the places where something is known."""
    borders = 0.5 * (along + np.append(along[1:], along[0] + length))
    return np.asarray(np.searchsorted(borders, places) % along.size)


def _passed(run: Run) -> FloatArray:
    """Length of unstretched belt that has passed at every output, m."""
    time, speed = run.dataset["time"].values, run.dataset["belt_speed"].values.mean(axis=1)
    return running_integral(speed * run.prepared.belt_length / run.prepared.path.length, time)


def _fields(run: Run, outputs: slice) -> _Fields:
    """The fields at some outputs along the belt."""
    run.require_output()
    prepared = run.prepared
    if prepared.ends:
        raise ModelError("an open belt has no turns, and so no history of tension and bending over them.")
    dataset = run.dataset.isel(field_time=outputs)
    nodes = dataset["nodal_coordinates"].values
    lengths = element_lengths(dataset, prepared.belt_length)
    along, curvature = _curvature(recorded_kind(dataset, prepared), nodes, lengths)
    middles, places = dataset["element_coordinate"].values, along.ravel()
    force_line = dataset["belt_tension"].values + _carried(prepared) * np.mean(curvature**2, axis=-1)
    tension = np.stack([np.interp(places, middles, one, period=prepared.belt_length) for one in force_line])
    pulley = np.repeat(_nearest_pulley(dataset, prepared, nodes[..., :2]), along.shape[-1], axis=-1)
    bending = curvature.reshape(len(nodes), -1)
    return _Fields(dataset["field_time"].values, places, tension, bending, pulley)


def _carried(prepared: Prepared) -> float:
    """Tension of the line of force less that of the elements, over the squared curvature, N m^2."""
    return prepared.belt.bending_stiffness * (0.5 - prepared.element_kind.bent_strain)


def _curvature(kind: ElementKind, nodes: FloatArray, lengths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places in elements, m, shape (elements, k), and the curvature there, shape (outputs, elements, k).

    Of elements whose curvature jumps at nodes there is the mean alone.
    """
    starts = np.cumsum(lengths) - lengths
    if len(kind.vectors) < _SMOOTH_VECTORS:
        return (starts + 0.5 * lengths)[:, None], mean_curvature(kind, nodes, lengths)[..., None]
    xi = np.arange(PLACES) / PLACES
    return starts[:, None] + lengths[:, None] * xi, curvatures(kind, nodes, lengths, xi)


def _nearest_pulley(dataset: "xr.Dataset", prepared: Prepared, nodes: FloatArray) -> IntArray:
    """Number of the pulley whose circle is nearest to the middle of each element, shape (outputs, elements)."""
    middles = 0.5 * (nodes + np.roll(nodes, -1, axis=1))
    centers = dataset["pulley_center"].sel(time=dataset["field_time"].values).values
    distance = np.linalg.norm(middles[:, :, None] - centers[:, None], axis=-1) - np.abs(prepared.radii)
    return np.asarray(np.abs(distance).argmin(axis=-1))


def mid_span_displacements(
    prepared: Prepared, centers: FloatArray, places: FloatArray, touched: IntArray
) -> FloatArray:
    """Distance of the belt from the middles of the straight lines between tangent points.

    Parameters
    ----------
    prepared : Prepared
        Effective radii and sides.
    centers : ndarray, shape (k, pulleys, 2)
        Where the pulleys are, m.
    places : ndarray, shape (k, points, 2)
        Where points of the belt are, m.
    touched : ndarray of int, shape (k, points)
        Number of the pulley that each touches, -1 where it is free.

    Returns
    -------
    ndarray, shape (k, spans)
        m, to the left of the direction of ascending belt coordinate; NaN where the belt has left a pulley.
    """
    lines = span_points(centers, *prepared.path.shape)
    result = np.full(lines.shape[:2], np.nan)
    left = np.where(touched >= 0, prepared.path.leaving[touched], -1)
    fill_mid_spans(lines, np.ascontiguousarray(places), left, prepared.path.ends is not None, result)
    return result


@kernel
def fill_mid_spans(lines: FloatArray, places: FloatArray, left: IntArray, is_open: bool, result: FloatArray) -> None:
    """Find where the free belt crosses the middles of spans.

    `lines`: ends of the straight spans, m, shape (k, spans, 2, 2); `places`: as for `mid_span_displacements`; `left`:
    number of the span that leaves the pulley that each point touches, -1 where it is free, shape (k, points);
    `is_open`: whether the belt has two ends, the last span being that from the first of them; `result`: overwritten
    where the belt does cross, m, shape (k, spans).
    """
    spans, count = lines.shape[1], left.shape[1]
    for k in range(left.shape[0]):
        first = 0
        while first < count and left[k, first] < 0:
            first += 1
        if is_open:
            before, start, last = spans - 1, -1, count
        elif first < count:
            before, start, last = left[k, first], first, first + count
        else:
            continue
        for walk in range(start + 1, last + 1):
            after = spans - 1 if is_open and walk == count else left[k, walk % count]
            if after < 0:
                continue
            if after == (before + 1) % spans:
                for one in range(start + 1, walk - 1):
                    x, y = _from_middle(lines[k, before], places[k, one % count])
                    next_x, next_y = _from_middle(lines[k, before], places[k, (one + 1) % count])
                    if x <= 0.0 and next_x > 0.0:
                        result[k, before] = y + x / (x - next_x) * (next_y - y)
                        break
            before, start = after, walk


@kernel(inline=True)
def _from_middle(line: FloatArray, place: FloatArray) -> tuple[float, float]:
    """Place of a point along a line from its middle, and to the left of it, m."""
    along_x, along_y = line[1, 0] - line[0, 0], line[1, 1] - line[0, 1]
    length = sqrt(along_x * along_x + along_y * along_y)
    along_x, along_y = along_x / length, along_y / length
    dx, dy = place[0] - line[0, 0], place[1] - line[0, 1]
    return dx * along_x + dy * along_y - 0.5 * length, dy * along_x - dx * along_y

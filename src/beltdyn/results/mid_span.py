"""Mid-span displacements from the position of the belt."""

from collections.abc import Sequence
from math import sqrt

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.model import Prepared
from beltdyn.model.path import span_points


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
    following = _following(lines.shape[1], prepared.path.beside)
    fill_mid_spans(lines, np.ascontiguousarray(places), touched, centers.shape[1], following, result)
    return result


def _following(spans: int, beside: Sequence[int]) -> IntArray:
    """Number of the pulley to which each span leads, shape (spans,); that of its second end is one past the pulleys."""
    found = np.arange(1, spans + 1) % spans
    for _ in beside:
        found = np.where(np.isin(found, beside), (found + 1) % spans, found)
    return found


@kernel
def fill_mid_spans(
    lines: FloatArray, places: FloatArray, touched: IntArray, pulleys: int, following: IntArray, result: FloatArray
) -> None:
    """Find where the free belt crosses the middles of spans.

    Parameters
    ----------
    lines : ndarray, shape (k, spans, 2, 2)
        Ends of the straight spans, m.
    places, touched
        As for `mid_span_displacements`.
    pulleys
        Number of pulleys; an open belt has one span more.
    following : ndarray of int, shape (spans,)
        Pulley to which each span leads.
    result : ndarray, shape (k, spans)
        Overwritten where the belt does cross, m.
    """
    spans, count = lines.shape[1], touched.shape[1]
    is_open = spans > pulleys
    for k in range(touched.shape[0]):
        first = 0
        while first < count and touched[k, first] < 0:
            first += 1
        if is_open:
            before, start, last = pulleys, -1, count
        elif first < count:
            before, start, last = touched[k, first], first, first + count
        else:
            continue
        for walk in range(start + 1, last + 1):
            after = pulleys if is_open and walk == count else touched[k, walk % count]
            if after < 0:
                continue
            if after == following[before]:
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

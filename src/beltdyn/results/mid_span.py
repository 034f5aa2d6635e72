"""How far spans move sideways, from where the belt is."""

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.model.path import span_points


def mid_span_displacements(drive: Drive, centers: FloatArray, places: FloatArray, touched: IntArray) -> FloatArray:
    """Distance of the belt from the middles of the straight lines between tangent points.

    Parameters
    ----------
    drive : Drive
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
    lines = span_points(centers, drive.path.radii)
    before, after = _neighbours(touched)
    spans = lines.shape[1]
    of_span = [(before == span) & (after == (span + 1) % spans) & (touched < 0) for span in range(spans)]
    return np.stack([_middle(places, free, lines[:, span]) for span, free in enumerate(of_span)], axis=1)


def _neighbours(touched: IntArray) -> tuple[IntArray, IntArray]:
    """Pulleys that the closed belt touches last before and first after each point, shape (time, points)."""
    twice = np.concatenate([touched, touched], axis=1)
    points = touched.shape[1]
    return _last_touched(twice)[:, points:], _last_touched(twice[:, ::-1])[:, points:][:, ::-1]


def _last_touched(touched: IntArray) -> IntArray:
    """Pulley that is touched at or before each point, -1 if there is none."""
    index = np.maximum.accumulate(np.where(touched >= 0, np.arange(touched.shape[1]), 0), axis=1)
    return np.take_along_axis(touched, index, axis=1)


def _middle(places: FloatArray, free: BoolArray, points: FloatArray) -> FloatArray:
    """Distance of the belt from the middle of lines, shape (time,).

    Parameters
    ----------
    places : ndarray, shape (time, points, 2)
        Points of the belt, m.
    free : ndarray of bool, shape (time, points)
        Which of them are those of the span.
    points : ndarray, shape (time, 2, 2)
        Ends of the lines, m.
    """
    line = points[:, 1] - points[:, 0]
    length = np.hypot(line[:, 0], line[:, 1])[:, None]
    x, y = line[:, :1] / length, line[:, 1:] / length
    dx, dy = (places[..., axis] - points[:, 0, axis, None] for axis in (0, 1))
    along, aside = dx * x + dy * y - 0.5 * length, dy * x - dx * y
    next_along = np.roll(along, -1, axis=1)
    crossing = free & np.roll(free, -1, axis=1) & (along <= 0.0) & (next_along > 0.0)
    row, one = np.arange(len(places)), np.argmax(crossing, axis=1)
    other = (one + 1) % places.shape[1]
    part = along[row, one] / np.where(np.any(crossing, axis=1), along[row, one] - along[row, other], np.nan)
    return np.asarray(aside[row, one] + part * (aside[row, other] - aside[row, one]))

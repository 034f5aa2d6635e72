"""Spans: their tensions in numbers, and how far they move sideways."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from beltdyn.model import Path
from beltdyn.results.derived.labels import labelled, window
from beltdyn.results.run import Run

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]


def span_tensions(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Mean, least and largest tension of every span.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    xarray.Dataset
        ``mean``, ``min`` and ``max``, N, by span.
    """
    tension = window(run, start, end)["span_tension"]
    numbers = {
        "mean": (tension.mean("time"), "Mean span tension"),
        "min": (tension.min("time"), "Least span tension"),
        "max": (tension.max("time"), "Largest span tension"),
    }
    return xr.Dataset(
        {name: value.assign_attrs(units="N", long_name=meaning) for name, (value, meaning) in numbers.items()}
    )


def mid_span_displacements(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Transverse displacement of every span at its middle.

    The straight line between the tangent points of the two pulleys, where these are at the instant, is zero; the
    belt's place is interpolated between the recorded points of the free belt before and after the middle. Since the
    belt sinks into pulleys, it is a little off zero even at rest.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        m, time and span, positive to the left of the direction of ascending belt coordinate: inwards on a drive
        without crossings; NaN where the belt has left a pulley.
    """
    dataset = window(run, start, end)
    points = _span_points(run, dataset["pulley_center"].values)
    before, after = _neighbours(dataset["contact_pulley"].values)
    places = dataset["contact_position"].values
    like = dataset["span_tension"]
    values = np.full(like.shape, np.nan)
    spans = values.shape[1]
    for span in range(spans):
        free = (before == span) & (after == (span + 1) % spans) & (dataset["contact_pulley"].values < 0)
        values[:, span] = _middle(places, free, points[:, span])
    return labelled(values, like, "m", "Mid-span displacement")


def _span_points(run: Run, centers: FloatArray) -> FloatArray:
    """Tangent points, shape (time, span, 2, 2), m; all the same where no pulley moves."""
    radii = run.drive.path.radii
    if np.all(centers == centers[0]):
        return np.broadcast_to(Path(centers[0], radii).span_points, (len(centers), len(radii), 2, 2))
    return np.array([Path(center, radii).span_points for center in centers])


def _neighbours(touched: IntArray) -> tuple[IntArray, IntArray]:
    """Pulleys that the closed belt touches last before and first after each point, shape (time, points)."""
    twice = np.concatenate([touched, touched], axis=1)
    points = touched.shape[1]
    return _last_touched(twice)[:, points:], _last_touched(twice[:, ::-1])[:, points:][:, ::-1]


def _last_touched(touched: IntArray) -> IntArray:
    """Pulley that is touched at or before each point, -1 if there is none."""
    index = np.maximum.accumulate(np.where(touched >= 0, np.arange(touched.shape[1]), 0), axis=1)
    return np.take_along_axis(touched, index, axis=1)


def _middle(places: FloatArray, free: NDArray[np.bool_], points: FloatArray) -> FloatArray:
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

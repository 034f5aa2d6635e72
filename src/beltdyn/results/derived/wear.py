"""Wear intensity: work of friction, by place on the arc and by place on the belt (Archard 1953: wear grows with it)."""

from collections.abc import Iterator

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from beltdyn.results.derived.arc import angle_from_inlet, arc_ends
from beltdyn.results.derived.labels import window
from beltdyn.results.mechanics import cells
from beltdyn.results.run import Run

FloatArray = NDArray[np.float64]
_BLOCK = 256
_BEYOND = 0.25
"""Shares of the arc between the tangent points that are looked at before and behind it."""


def wear_by_arc(run: Run, bins: int = 60, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Give the work of |f_t v_t| by place on the arc of each pulley.

    In each of equal parts of the arc, the work done on the belt in it is summed and divided by its length, so that
    the sum over a pulley is all of its work. The parts reach a quarter of the arc between the tangent points further at
    both of its ends, since a belt that sinks in or bends touches before them.

    Parameters
    ----------
    run : Run
        The run.
    bins : int
        Number of parts.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        J per metre of arc, pulley and ``share``: the middle of the part, 0 at the tangent point where the belt enters
        when it runs in the direction of ascending belt coordinate, 1 at the other; ``angle`` (rad) and ``part_length``
        (m) belong to it.
    """
    dataset = window(run, start, end)
    drive, pulleys = run.drive, len(run.drive.pulleys)
    inlet, wrap = arc_ends(drive, dataset["pulley_center"].values.mean(axis=0))
    cell = cells(dataset["belt_coordinate"].values, drive.belt.length)
    work = np.zeros((pulleys, bins))
    for part, seconds in _blocks(dataset):
        power = _power(part) * cell * seconds[:, None]
        touched, place, center = (part[name].values for name in ("contact_pulley", "contact_position", "pulley_center"))
        for number, pulley in enumerate(drive.pulleys):
            row, point = np.nonzero(touched == number)
            away = place[row, point] - center[row, number]
            share = angle_from_inlet(away, inlet[number], wrap[number], pulley.turning) / wrap[number]
            index = np.clip(((share + _BEYOND) / (1.0 + 2.0 * _BEYOND) * bins).astype(int), 0, bins - 1)
            work[number] += np.bincount(index, weights=power[row, point], minlength=bins)
    length = np.broadcast_to(((1.0 + 2.0 * _BEYOND) * drive.radii * wrap / bins)[:, None], work.shape)
    share = (1.0 + 2.0 * _BEYOND) * (np.arange(bins) + 0.5) / bins - _BEYOND
    dims = ("pulley", "share")
    return xr.DataArray(
        work / length,
        {
            "pulley": dataset["pulley"],
            "share": ("share", share, {"units": "1", "long_name": "Share of the arc from the inlet"}),
            "angle": (dims, np.outer(wrap, share), {"units": "rad", "long_name": "Angle from the inlet"}),
            "part_length": (dims, length, {"units": "m", "long_name": "Length of the part of the arc"}),
        },
        dims,
        attrs={"units": "J/m", "long_name": "Wear intensity on the arc"},
    )


def wear_by_belt(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Give the work of |f_t v_t| by place on the belt.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        J per metre of belt, pulley and contact_point: what each pulley does to each place of the belt. Pulleys
        at its back wear the other surface.
    """
    dataset = window(run, start, end)
    work = np.zeros((len(run.drive.pulleys), dataset.sizes["contact_point"]))
    for part, seconds in _blocks(dataset):
        power, touched = _power(part), part["contact_pulley"].values
        for number in range(len(work)):
            work[number] += np.einsum("kp,kp,k->p", power, touched == number, seconds)
    coordinates = {"pulley": dataset["pulley"], "belt_coordinate": dataset["belt_coordinate"]}
    attributes = {"units": "J/m", "long_name": "Wear intensity on the belt"}
    return xr.DataArray(work, coordinates, ("pulley", "contact_point"), attrs=attributes)


def _power(part: xr.Dataset) -> FloatArray:
    """Power |f_t v_t|, W/m, shape (time, contact_point)."""
    return np.asarray(np.abs(part["friction_force"].values * part["slip_velocity"].values))


def _blocks(dataset: xr.Dataset) -> Iterator[tuple[xr.Dataset, FloatArray]]:
    """Some outputs at a time, and the time that each stands for by the trapezoidal rule, s."""
    steps = np.diff(dataset["time"].values)
    seconds = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
    for first in range(0, len(seconds), _BLOCK):
        rows = slice(first, first + _BLOCK)
        yield dataset.isel(time=rows), seconds[rows]

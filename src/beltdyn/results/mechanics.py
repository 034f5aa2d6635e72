"""Formulas of belt drives on plain arrays, for the summary and for whatever is derived from a dataset.

Along the last axis lie pulleys, spans or contact points. Span i leaves pulley i and reaches pulley i + 1; the
last one reaches pulley 0.
"""

from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.elements import ELEMENTS, ElementKind
from beltdyn.model import Drive

if TYPE_CHECKING:
    import xarray as xr

UNLOADED = 1e-4
"""Difference of the tensions at a pulley, over their sum, up to which it counts as unloaded."""


def rim_speeds(speed: FloatArray, drive: Drive) -> FloatArray:
    """Speeds at which a belt without tension rolls on the rims, in the direction of ascending belt coordinate, m/s.

    Parameters
    ----------
    speed : ndarray, shape (..., pulleys)
        Pulley speeds, rad/s, counter-clockwise positive.
    drive : Drive
        A pulley at the belt's back turns clockwise where the others turn counter-clockwise.
    """
    turning = np.array([pulley.turning for pulley in drive.pulleys])
    return np.asarray(speed * drive.rolling_radii * turning)


def relative_loss(values: FloatArray, rim: FloatArray, reference: int) -> FloatArray:
    """What values of every pulley exceed that of the reference by, m/s, over its rim's speed.

    Parameters
    ----------
    values, rim : ndarray, shape (..., pulleys)
        Values, and speeds of the rims as from `rim_speeds`, m/s.
    reference : int
        Number of a pulley; NaN where it stands still.
    """
    against = slice(reference, reference + 1)
    lost, speed = values - values[..., against], rim[..., against]
    unknown = np.full(np.broadcast(lost, speed).shape, np.nan)
    return np.asarray(np.divide(lost, speed, out=unknown, where=speed != 0.0))


def across(spans: FloatArray, drive: Drive) -> tuple[FloatArray, FloatArray]:
    """Values of the spans before and after every pulley.

    Parameters
    ----------
    spans : ndarray, shape (..., spans)
        A value of every span.
    drive : Drive
        The drive.

    Returns
    -------
    before, after : ndarray, shape (..., pulleys)
        Of the spans that reach and leave each pulley, in the direction of ascending belt coordinate.
    """
    pulleys = len(drive.pulleys)
    return np.roll(spans, 1, axis=-1)[..., :pulleys], spans[..., :pulleys]


def cells(belt_coordinate: FloatArray, length: float) -> FloatArray:
    """Length of belt that each contact point stands for: half of the way to its neighbours, m.

    Parameters
    ----------
    belt_coordinate : ndarray, shape (points,)
        Ascending, m.
    length : float
        Unstretched length of the closed belt, m.
    """
    gaps = np.diff(belt_coordinate, append=belt_coordinate[0] + length)
    return np.asarray(0.5 * (gaps + np.roll(gaps, 1)))


def element_lengths(dataset: "xr.Dataset", belt_length: float) -> FloatArray:
    """Give the reference lengths of the elements.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result; only ``node_coordinate`` and the number of elements are used.
    belt_length : float
        Unstretched length of the belt, m.

    Returns
    -------
    ndarray, shape (elements,)
        Lengths between a node and the next along the belt, m.
    """
    nodes = dataset["node_coordinate"].values
    return np.diff(nodes, append=nodes[0] + belt_length)[: dataset.sizes["element"]]


def recorded_kind(dataset: "xr.Dataset", drive: Drive) -> ElementKind:
    """Give the kind of the elements whose nodal coordinates a result holds.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result.
    drive : Drive
        Its drive.

    Returns
    -------
    ElementKind
        The drive's, or that of a staying mesh.
    """
    given, names = drive.element_kind, tuple(dataset["coordinate"].values.tolist())
    return next(kind for kind in (given, *ELEMENTS.values()) if kind.coordinates == names)


def sliding_velocity(
    slip_velocity: FloatArray, normal: FloatArray, touched: IntArray, pulley_speed: FloatArray, drive: Drive
) -> FloatArray:
    """Slip velocity beyond creep: what is left of it when the friction law's creep v_c is taken away.

    v_c is the slip velocity at which |f_t| reaches mu f_n, which the friction law knows.
    The result is sign(v_t) max(|v_t| - v_c, 0) where the belt presses on a pulley, and zero elsewhere.

    Parameters
    ----------
    slip_velocity, normal : ndarray, shape (..., points)
        v_t (m/s) and f_n (N/m).
    touched : ndarray of int, shape (..., points)
        Number of the pulley that a point touches, -1 where it is free.
    pulley_speed : ndarray, shape (..., pulleys)
        rad/s.
    drive : Drive
        Friction.
    """
    rim = np.take_along_axis(pulley_speed * drive.radii, touched, axis=-1)
    creep = drive.friction_parameters.saturation(normal, drive.frictions[touched], rim)
    beyond = slip_velocity - np.clip(slip_velocity, -creep, creep)
    return np.where((touched >= 0) & (normal > 0.0), beyond, 0.0)


def sliding_shares(sliding: FloatArray, pressed: BoolArray, cell: FloatArray) -> FloatArray:
    """Part of every arc of contact on which the belt slides.

    Parameters
    ----------
    sliding : ndarray, shape (k, points)
        Result of `sliding_velocity`.
    pressed : ndarray of bool, shape (k, pulleys, points)
        Where the belt presses on each pulley; see `pressing`.
    cell : ndarray, shape (points,)
        Result of `cells`.

    Returns
    -------
    ndarray, shape (k, pulleys)
        Zero without contact.
    """
    lengths = pressed @ cell
    slid = (pressed & (sliding != 0.0)[:, None]) @ cell
    return np.asarray(np.divide(slid, lengths, out=np.zeros_like(lengths), where=lengths > 0.0))


def pressing(normal: FloatArray, touched: IntArray, pulleys: int) -> BoolArray:
    """Where the belt presses on each pulley, shape (k, pulleys, points)."""
    return np.asarray((touched[:, None] == np.arange(pulleys)[:, None]) & (normal > 0.0)[:, None])


def gross_sliding(sliding: FloatArray, pressed: BoolArray, drive: Drive) -> FloatArray:
    """Velocity at which the belt slides on the whole arc of each pulley, m/s along the belt.

    The sliding velocity nearest to zero of all points that press; zero as soon as one of them only creeps, or slides
    the other way.

    Parameters
    ----------
    sliding : ndarray, shape (k, points)
        Result of `sliding_velocity`.
    pressed : ndarray of bool, shape (k, points, pulleys)
        Result of `pressing`.
    drive : Drive
        Sides of the pulleys.

    Returns
    -------
    ndarray, shape (k, pulleys)
        Belt faster than the rim in the direction of ascending belt coordinate.
    """
    lowest = np.where(pressed, sliding[:, None], np.inf).min(axis=-1)
    highest = np.where(pressed, sliding[:, None], -np.inf).max(axis=-1)
    turning = np.array([pulley.turning for pulley in drive.pulleys])
    nearest = np.where(lowest > 0.0, lowest, np.minimum(highest, 0.0))
    return np.asarray(turning * np.where(np.any(pressed, axis=-1), nearest, 0.0))

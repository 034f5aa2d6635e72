"""Places on the arcs of pulleys, from circles alone."""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.model.path import span_directions, span_points, wrap_angles


def arc_ends(drive: Drive, centers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give the angles at which the belt's path reaches pulleys and the wrap angles.

    Parameters
    ----------
    drive : Drive
        Effective radii and sides.
    centers : ndarray, shape (..., pulleys, 2)
        Where the pulleys are, m.

    Returns
    -------
    inlet, wrap : ndarray, shape (..., pulleys)
        Angle of the tangent point where the span before each pulley ends, from the x axis; wrap angle; rad.
    """
    radii, ends = drive.path.radii, drive.path.ends
    reached = np.roll(span_points(centers, radii, ends)[..., 1, :], 1, axis=-2)[..., : len(radii), :] - centers
    return np.arctan2(reached[..., 1], reached[..., 0]), wrap_angles(span_directions(centers, radii, ends), radii)


def angle_from_inlet(place: FloatArray, inlet: ArrayLike, wrap: ArrayLike, turning: ArrayLike) -> FloatArray:
    """Angle of points around a pulley in the direction of ascending belt coordinate.

    Parameters
    ----------
    place : ndarray, shape (k, 2)
        Points, from the pulley's center, m.
    inlet, wrap : array_like, shape (k,) or a number
        See `arc_ends`.
    turning : array_like, shape (k,) or a number
        1, or -1 for a pulley at the belt's back.

    Returns
    -------
    ndarray, shape (k,)
        rad, zero at the inlet, negative shortly before it.
    """
    free = 0.5 * (2.0 * np.pi - np.asarray(wrap))
    turned = np.asarray(turning) * (np.arctan2(place[:, 1], place[:, 0]) - np.asarray(inlet))
    return np.asarray(np.mod(turned + free, 2.0 * np.pi) - free)

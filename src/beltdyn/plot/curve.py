"""The belt's centreline as smooth curves, from nodal coordinates."""

import numpy as np
import xarray as xr

from beltdyn.arrays import FloatArray

POINTS = 17
"""Points drawn on an element, ends included."""


def element_lengths(dataset: xr.Dataset, belt_length: float) -> FloatArray:
    """Give the reference lengths of the elements.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result; only ``node_coordinate`` is used.
    belt_length : float
        Unstretched length of the closed belt, m.

    Returns
    -------
    ndarray, shape (elements,)
        Lengths between a node and the next around the belt, m.
    """
    nodes = dataset["node_coordinate"].values
    return np.diff(nodes, append=nodes[0] + belt_length)


def centerline(coordinates: FloatArray, lengths: FloatArray, points: int = POINTS) -> FloatArray:
    """Interpolate the centreline by the element's cubic Hermite polynomials (Eq. 6), or by straight links.

    Parameters
    ----------
    coordinates : ndarray, shape (nodes, 6) or (nodes, 2)
        Nodal coordinates: positions (m) and, but for links, slopes along the belt first.
    lengths : ndarray, shape (nodes,)
        Reference length from each node to the next around the belt, m.
    points : int
        Points on an element, ends included.

    Returns
    -------
    ndarray, shape (nodes, points, 2)
        Points on the element that begins at each node, m.
    """
    xi = np.linspace(0.0, 1.0, points)[None, :, None]
    position = coordinates[:, None, 0:2]
    next_position = np.roll(position, -1, axis=0)
    if coordinates.shape[1] == 2:
        return (1 - xi) * position + xi * next_position
    slope = coordinates[:, None, 2:4]
    next_slope = np.roll(slope, -1, axis=0)
    length = lengths[:, None, None]
    return (
        (1 - 3 * xi**2 + 2 * xi**3) * position
        + (xi - 2 * xi**2 + xi**3) * length * slope
        + (3 * xi**2 - 2 * xi**3) * next_position
        + (xi**3 - xi**2) * length * next_slope
    )

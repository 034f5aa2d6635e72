"""The belt's centreline as smooth curves, from nodal coordinates."""

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.contact.bezier import BINOMIALS
from beltdyn.elements import ElementKind

POINTS = 17
"""Points drawn on an element, ends included."""


def centerline(kind: ElementKind, coordinates: FloatArray, lengths: FloatArray, points: int = POINTS) -> FloatArray:
    """Points on the centreline, by the Bezier curves of the elements.

    Parameters
    ----------
    kind : ElementKind
        Of the elements; `mechanics.recorded_kind` of a result.
    coordinates : ndarray, shape (nodes, k)
        Nodal coordinates of a result: positions (m) first.
    lengths : ndarray, shape (elements,)
        Reference length from each node to the next along the belt, m.
    points : int
        Points on a curve, ends included.

    Returns
    -------
    ndarray, shape (nodes, points, 2)
        Points on the curve that begins at each node, m.
    """
    xi = np.linspace(0.0, 1.0, points)
    curves = np.arange(len(lengths))
    places = curve_points(kind, coordinates, lengths, np.repeat(curves, points), np.tile(xi, len(curves)))
    return places.reshape(-1, points, 2)


def curve_points(
    kind: ElementKind, coordinates: FloatArray, lengths: FloatArray, curve: IntArray, xi: FloatArray
) -> FloatArray:
    """Points anywhere on the centreline, at one instant or at several.

    Parameters
    ----------
    kind : ElementKind
        Of the elements.
    coordinates : ndarray, shape (..., nodes, k)
        Nodal coordinates of a result.
    lengths : ndarray, shape (elements,)
        Reference length from each node to the next along the belt, m.
    curve : ndarray of int, shape (points,)
        The node at which the curve of each point begins.
    xi : ndarray, shape (points,)
        Where on its curve each point is, from 0 to 1.

    Returns
    -------
    ndarray, shape (..., points, 2)
        m.
    """
    instants = coordinates.shape[:-2]
    first = coordinates.reshape(*instants, -1, kind.dof)
    elements = len(lengths) // kind.points
    element = np.concatenate([first, np.roll(first, -1, axis=-2)], axis=-1)[..., :elements, :]
    vectors = np.stack([element[..., start : start + 2] for start in kind.vectors], axis=-2)
    control = kind.control(lengths.reshape(elements, -1).sum(axis=1))
    points = np.einsum("ncpv,...nva->...ncpa", control, vectors).reshape(*instants, -1, control.shape[2], 2)
    degree, along = control.shape[2] - 1, xi[:, None]
    order = np.arange(degree + 1)
    weights = BINOMIALS[degree, order] * along**order * (1.0 - along) ** (degree - order)
    return np.asarray(np.einsum("kp,...kpa->...ka", weights, points[..., curve, :, :]))

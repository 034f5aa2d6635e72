"""The belt's centreline as smooth curves, from nodal coordinates."""

import numpy as np

from beltdyn.arrays import FloatArray
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
    first = coordinates.reshape(-1, kind.dof)
    elements = len(lengths) // kind.points
    element = np.hstack([first, np.roll(first, -1, axis=0)])[:elements]
    vectors = np.stack([element[:, start : start + 2] for start in kind.vectors], axis=1)
    control = np.stack([kind.control(float(np.sum(length))) for length in lengths.reshape(elements, -1)])
    degree, xi = control.shape[2] - 1, np.linspace(0.0, 1.0, points)[:, None]
    order = np.arange(degree + 1)
    weights = BINOMIALS[degree, order] * xi**order * (1.0 - xi) ** (degree - order)
    return np.asarray(np.einsum("pk,nckv,nva->ncpa", weights, control, vectors)).reshape(-1, points, 2)

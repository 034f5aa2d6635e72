"""How the mesh stands to the belt: it travels with the material, or stays in place while the belt flows through it.

In a mesh that stays, the point r(sigma, t) of the centreline is that of the material point sigma - s(t), with s the
length of unstretched belt that has passed.  Its velocity is dr/dt + (ds/dt) dr/dsigma.  Within an element the second
term is a polynomial like r itself, so that vectors D e of the element's own carry it exactly; derivatives of second and
third order, which jump from element to element, make these vectors differ from those of the neighbour.
"""

from collections.abc import Callable
from math import comb
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.quadrature import gauss_points


class Travelling(NamedTuple):
    """The mesh travels with the belt."""

    speed: float = 0.0
    """Of the belt against the mesh, m/s."""


class Staying(NamedTuple):
    """The mesh stays in place."""

    speed: FloatArray
    """Length of unstretched belt that passes in a unit of time, m/s, shape (1,)."""
    derivative: FloatArray
    """D, vectors of dr/dsigma from those of r, 1/m, shape (elements, v, v)."""
    inertia: FloatArray
    """C, the integral of rho A S'^T S' over the vectors, kg/m, shape (elements, v, v)."""


def staying(control: FloatArray, length: FloatArray, mass: float) -> Staying:
    """Make the frame of a mesh that stays, with a belt at rest.

    Parameters
    ----------
    control : ndarray, shape (elements, 1, degree + 1, v)
        Control points of the centreline from the vectors, as many as these.
    length : ndarray, shape (elements,)
        Reference lengths, m.
    mass
        Mass of a metre of belt, kg/m.
    """
    degree = control.shape[2] - 1
    basis = control[:, 0]
    derivative = np.linalg.solve(basis, _hodograph(degree) @ basis) / length[:, None, None]
    xi, weights = gauss_points(degree + 1)
    bernstein = np.array([comb(degree, k) * xi**k * (1.0 - xi) ** (degree - k) for k in range(degree + 1)]).T
    slopes = bernstein @ basis @ derivative
    inertia = mass * np.einsum("q,e,eqa,eqb->eab", weights, length, slopes, slopes)
    return Staying(np.zeros(1), np.ascontiguousarray(derivative), inertia)


def _hodograph(degree: int) -> FloatArray:
    """Control points of the derivative of a Bezier curve, raised to the same degree, from those of the curve."""
    change = degree * (np.eye(degree, degree + 1, 1) - np.eye(degree, degree + 1))
    raised, parts = np.zeros((degree + 1, degree)), np.arange(degree + 1) / degree
    for k in range(degree + 1):
        if k > 0:
            raised[k, k - 1] = parts[k]
        if k < degree:
            raised[k, k] = 1.0 - parts[k]
    return np.asarray(raised @ change)


@kernel
def _no_flow(
    frame: Travelling, element: int, vectors: tuple[int, ...], position: FloatArray, velocity: FloatArray
) -> None:
    """Leave the velocity: nodes move with the belt."""


@kernel
def _flow(frame: Staying, element: int, vectors: tuple[int, ...], position: FloatArray, velocity: FloatArray) -> None:
    """Add speed D e to the velocity."""
    speed, derivative = frame.speed[0], frame.derivative[element]
    for a in range(len(vectors)):
        for axis in range(2):
            total = 0.0
            for b in range(len(vectors)):
                total += derivative[a, b] * position[vectors[b] + axis]
            velocity[vectors[a] + axis] += speed * total


add_flow: Callable[[Any, int, tuple[int, ...], FloatArray, FloatArray], None] = by_type(
    {Travelling: _no_flow, Staying: _flow}, "add_flow"
)
"""Add to the velocity of an element, shape (2 n,), what the belt's flow through the mesh gives its material points."""

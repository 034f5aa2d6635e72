"""Tension and stretch of a belt by Green's strain, N = EA (g^2 - 1) g / 2 (first term of Eq. 14)."""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray


def tension(stretch: ArrayLike, axial_stiffness: float) -> FloatArray:
    """Tension N = EA (g^2 - 1) g / 2.

    Parameters
    ----------
    stretch
        g, length over reference length.
    axial_stiffness
        EA, N.

    Returns
    -------
    ndarray
        N, N: the force that does the work of a change of g.

    Examples
    --------
    >>> round(float(bd.theory.stretch.tension(1.01, axial_stiffness=1e4)), 3)
    101.505
    """
    g = np.asarray(stretch, dtype=float)
    return np.asarray(0.5 * axial_stiffness * (g * g - 1.0) * g)


def tangent_stiffness(stretch: ArrayLike, axial_stiffness: float) -> FloatArray:
    """Rate dN/dg = EA (3 g^2 - 1) / 2, N; parameters as for `tension`."""
    g = np.asarray(stretch, dtype=float)
    return np.asarray(0.5 * axial_stiffness * (3.0 * g * g - 1.0))


def stretch(tension: ArrayLike, axial_stiffness: float) -> FloatArray:
    """Stretch g under a tension: the root of g^3 - g - 2 N / EA = 0 that is 1 without tension.

    Parameters
    ----------
    tension
        N, N; above -EA / sqrt(27), where a belt of this law gives way.
    axial_stiffness
        EA, N.

    Returns
    -------
    ndarray
        g, by Cardano's formula: 2 / sqrt(3) cos(arccos(x) / 3) with x = sqrt(27) N / EA, or with arcosh for x > 1.

    Examples
    --------
    >>> round(float(bd.theory.stretch.stretch(101.505, axial_stiffness=1e4)), 6)
    1.01
    """
    x = np.sqrt(27.0) * np.asarray(tension, dtype=float) / axial_stiffness
    third = np.where(
        x <= 1.0,
        np.cos(np.arccos(np.clip(x, -1.0, 1.0)) / 3.0),
        np.cosh(np.arccosh(np.maximum(x, 1.0)) / 3.0),
    )
    return np.asarray(2.0 / np.sqrt(3.0) * third)


def stretch_with_penetration(length: float, path: float, axial_stiffness: float, sinking: float) -> float:
    """Stretch g of a belt at rest that sinks into its pulleys: the root of g length + sinking T g = path, T of g.

    Parameters
    ----------
    length
        Of the unstretched belt, m.
    path
        Length of the path around the pulleys' rims, m, not below `length`.
    axial_stiffness
        EA, N.
    sinking
        How much shorter the path becomes for each newton of T g, m/N: the sum over the pulleys of wrap angle / (R k_p)
        where a belt that presses with T g / R per reference length sinks by T g / (R k_p).

    Returns
    -------
    float
        By Newton's method from path / length: the left side grows with g, ever faster, so that it falls to the root.
    """
    g, lower = np.inf, path / length
    while lower < g:
        g = lower
        force = float(tension(g, axial_stiffness))
        slope = length + sinking * (force + float(tangent_stiffness(g, axial_stiffness)) * g)
        lower = g - (g * length + sinking * force * g - path) / slope
    return g

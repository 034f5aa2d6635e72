"""Stretch of a belt at rest that sinks into its pulleys, which shortens its path."""

import numpy as np

from beltdyn.theory.stretch import tangent_stiffness, tension


def sunk_stretch(length: float, path: float, axial_stiffness: float, sinking: float) -> float:
    """Stretch g for which the belt is as long as its path: the root of g length + sinking T g = path, T of g.

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

"""Constant mass matrix of a piece of chain: the mass of the links, lumped at their ends as Leamy and Wasfy do."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.chain.chain_force import LINKS


def lumped_mass(mass: float, length: float) -> FloatArray:
    """Mass matrix of three links; the places p4 and p5 belong to the next piece and carry nothing here.

    Parameters
    ----------
    mass
        rho A, kg/m.
    length
        Reference length of the piece, m.

    Returns
    -------
    ndarray, shape (12, 12)
        Diagonal, kg.
    """
    at_points = np.array([0.5, 1.0, 1.0, 0.5, 0.0, 0.0])
    return np.diag(np.repeat(at_points * mass * length / LINKS, 2))

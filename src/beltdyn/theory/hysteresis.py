"""Energy that hysteresis takes from a metre of belt as it bends on to a pulley and off, and as its tension changes.

A material with the loss factor eta = tan delta = E''/E' loses in a cycle of the strain between two values

    pi E'' (half of their difference)^2 = pi / 4 eta E' (difference)^2

per volume (Ferry, Viscoelastic Properties of Polymers, 1980, chapter 1), 2 pi eta times the energy of the amplitude.  A
belt that bends from straight to the curvature 1 / R and back, and one whose tension goes from T2 to T1 and back, lose

    pi / 4 eta EI / R^2,    pi / 4 eta (T1 - T2)^2 / EA

a metre: pi / 2 eta of the energy of bending at the pulley.  That takes the loss of a cycle to depend on both values
alone, not on how fast and along which curve the strain goes between them.
"""

from math import pi
from typing import Final

import numpy as np

from beltdyn.arrays import FloatArray

BENDING_SHARE: Final = 0.25 * pi
"""Modulus of hysteresis over the loss factor and the stiffness, where a strain goes from the reference and back."""

STRETCH_SHARE: Final = 0.5 * pi
"""The same where a strain goes as far to one side of the reference as to the other."""


def bending_loss(bending_stiffness: float, loss_factor: float, radii: FloatArray) -> FloatArray:
    """Energy lost by a metre of belt on each pulley, J/m, which is a force in N that holds the belt back.

    Parameters
    ----------
    bending_stiffness : float
        E I, N m^2.
    loss_factor : float
        Of bending.
    radii : ndarray
        Radius R of the tension line on each pulley, m.
    """
    return np.asarray(BENDING_SHARE * loss_factor * bending_stiffness / np.asarray(radii) ** 2)


def stretch_loss(axial_stiffness: float, loss_factor: float, tight: float, slack: float) -> float:
    """Energy lost by a metre of belt whose tension goes from slack to tight and back, J/m.

    Parameters
    ----------
    axial_stiffness : float
        E A, N.
    loss_factor : float
        Of stretch.
    tight, slack : float
        Tensions T1 and T2, N.
    """
    return BENDING_SHARE * loss_factor * (tight - slack) ** 2 / axial_stiffness

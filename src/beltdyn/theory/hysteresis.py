"""Hysteresis loss per meter of belt: bending onto and off a pulley, tension, compression.

A material with the loss factor eta = tan delta = E''/E' loses in a cycle of the strain between two values

    pi E'' (half of their difference)^2 = pi / 4 eta E' (difference)^2

per volume (Ferry, Viscoelastic Properties of Polymers, 1980, chapter 1), 2 pi eta times the energy of the amplitude.  A
belt that bends from straight to the curvature 1 / R and back, and one whose tension goes from T2 to T1 and back, lose

    pi / 4 eta EI / R^2,    pi / 4 eta (T1 - T2)^2 / EA

a meter: pi / 2 eta of the energy of bending at the pulley.  That takes the loss of a cycle to depend on both values
alone, not on how fast and along which curve the strain goes between them.

A belt under T that is pressed into a pulley by T / R a meter, and is k hard, sinks in by d = T / (R k).  Where it comes
on and leaves it bends, and sinks in deeper, by r d.  With the same loss, pi / 2 eta of the energy, on each way between
0, r d and d a meter loses

    pi / 4 eta (2 r^2 - 1) T^2 / (k R^2).

Of a tensioned beam on springs, E I d'''' - T d'' + k d = T / R, whose curvature and shear go over into the span's, r
depends on q = E I k / T^2 alone.  Belts for which q is large lose in proportion to T sqrt(E I / k) / R^2: it is the
parameter sqrt(E I / k) / R^2 with which Childs and Cowburn (1987) found the torque losses of V-belts to go.
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
    """Bending loss per meter of belt on each pulley, J/m, equal to a resisting force in N."""
    return np.asarray(BENDING_SHARE * loss_factor * bending_stiffness / np.asarray(radii) ** 2)


def stretch_loss(axial_stiffness: float, loss_factor: float, tight: float, slack: float) -> float:
    """Loss per meter of belt over a tension cycle from slack to tight and back, J/m."""
    return BENDING_SHARE * loss_factor * (tight - slack) ** 2 / axial_stiffness


def deepest(stiffness: float) -> float:
    """Penetration at the ends of an arc over that along the arc."""
    first, second = np.roots([1.0, -1.0, stiffness * (1.0 + 1e-9)])  # squares of the rates of decay, in sqrt(T / E I)
    rates = np.sqrt(np.array([first, second], dtype=complex))
    parts = np.linalg.solve([np.ones(2), rates**2 + rates**3], [-1.0, -stiffness])
    along = np.linspace(0.0, 12.0, 2001) / np.abs(rates).mean()
    return float(np.max(1.0 + (parts @ np.exp(-np.outer(rates, along))).real, initial=1.0))


def compression_loss(
    tension: float, bending_stiffness: float, contact_stiffness: float, loss_factor: float, radii: FloatArray
) -> FloatArray:
    """Compression loss per meter of belt on each pulley, J/m."""
    depth = deepest(bending_stiffness * contact_stiffness / tension**2)
    energy = (2.0 * depth**2 - 1.0) * tension**2 / contact_stiffness
    return np.asarray(BENDING_SHARE * loss_factor * energy / np.asarray(radii) ** 2)

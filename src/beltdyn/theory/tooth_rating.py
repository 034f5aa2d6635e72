"""Rating of toothed belts: allowed pull by the teeth in mesh, and the tension that keeps them there.

A belt whose teeth each carry F_z pulls, with z teeth in mesh of which at most z_most count,

    F = min(min(z, z_most) F_z(n), T_allowed) - m v^2,        P = F v.

Rubber belts are rated by their allowed tension, which is that of z_most = 6 teeth; the factor of fewer teeth is then
z / 6, where ISO 5295 has 1 - (6 - z) / 5.  Polyurethane belts are rated by the shear strength of a tooth, which falls
with the speed n of the pulley,

    F_z(n) = F_z (1 - c lg(1 + n / n_0)),

and by that of their cords; the law is a fit to makers' tables (Goodyear Elatech T5: c = 0.324 and n_0 = 93 rpm give
its values from 0 to 10 000 rpm within 2 %).
"""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray

REST_SHARE = 0.6
"""Tension at rest of a belt on two pulleys over its pull: half of it (Siegling, calculation methods for timing belts),
and a tenth more, which is left in the slack span."""
_ROUNDING = 1e-6
"""Of teeth in mesh."""


def whole_teeth(pitches: ArrayLike) -> FloatArray:
    """Teeth that are surely in mesh on an arc of so many pitches."""
    return np.asarray(np.floor(np.asarray(pitches) + _ROUNDING))


def mesh_factor(pitches: ArrayLike, most: float) -> FloatArray:
    """Share of a belt's pull that the teeth in mesh carry: whole teeth over the number that counts, at most 1.

    Examples
    --------
    >>> from beltdyn.theory.tooth_rating import mesh_factor
    >>> mesh_factor([4.9, 7.2], most=6).round(3).tolist()
    [0.667, 1.0]
    """
    return np.asarray(np.minimum(whole_teeth(pitches) / most, 1.0))


def speed_factor(speed: ArrayLike, loss: float, reference: float) -> FloatArray:
    """Allowed load of a tooth over that at rest: 1 - loss * lg(1 + n / n_0), with the speeds of pulley and reference.

    Examples
    --------
    >>> from beltdyn.theory.tooth_rating import speed_factor
    >>> (24.7 * speed_factor([0.0, 1500.0, 10000.0], 0.324, 93.0)).round(1).tolist()  # tabulated: 24.7, 15.0, 8.4
    [24.7, 14.8, 8.4]
    """
    return np.asarray(np.maximum(1.0 - loss * np.log10(1.0 + np.abs(speed) / reference), 0.0))


def least_rest_tension(pull: float, mass: float, speed: float) -> float:
    """Tension at rest of a belt on two pulleys that keeps its slack span tight, N.

    Parameters
    ----------
    pull : float
        Design power over belt speed, N.
    mass : float
        Per length, kg/m.
    speed : float
        Of the belt, m/s.
    """
    return REST_SHARE * pull + mass * speed**2


def pull_of_cords(tension: float, mass: float, speed: float) -> float:
    """Pull of a belt with that tension at rest whose tight span has the allowed tension (N), N."""
    return (tension - mass * speed**2) / (REST_SHARE + 0.5)

"""Ratings of belts and teeth by width and speed.

Power rating of V-belts and V-ribbed belts: the rating law of standards and catalogs, and its factors.

A belt, or rib, on two equal pulleys whose tension line has the diameter d carries, at the belt speed v, the pull

    F = c1 - c2 / d - c3 v^2 - c4 lg(v / (1 m/s)),        P = F v.

c2 takes off what bending costs, c3 is centrifugal and near the mass per length, c4 stands for the number of turns that
the belt has to live. The law is that of ISO 5292, RMA IP-20 and GB/T 13575.1, P = d n (k1 - k2/d - k3 (d n)^2 -
k4 lg(d n)), with n in SI units.

On the larger of two unequal pulleys the belt bends less. Where the damage by a pulley grows as d^-x, both are as two
equal ones of K times the smaller diameter, with the ratio i of the diameters:

    K = (2 / (1 + i^-x))^(1/x),        P_ratio = c2 v / d (1 - 1/K).

Tables of K in standards are this function: RMA IP-20 ends at 1.1106 (x = 6.6), GB/T 13575.1 at 1.1373 (x = 5.4).

Rating of toothed belts: allowed pull by the teeth in mesh, and the tension that keeps them there.

A belt whose teeth each carry F_z pulls, with z teeth in mesh of which at most z_most count,

    F = min(min(z, z_most) F_z(n), T_allowed) - m v^2,        P = F v.

Rubber belts are rated by their allowed tension, which is that of z_most = 6 teeth; the factor of fewer teeth is then
z / 6, where ISO 5295 has 1 - (6 - z) / 5.  Polyurethane belts are rated by the shear strength of a tooth, which falls
with the speed n of the pulley,

    F_z(n) = F_z (1 - c lg(1 + n / n_0)),

and by that of their cords; the law is a fit to makers' tables (Goodyear Elatech T5: c = 0.324 and n_0 = 93 rpm give
its values from 0 to 10 000 rpm within 2 %).
"""

from math import pi
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.parts.ranges import require_above, require_at_least

_HALF_TURN, _BASE = 1.25, 5.0
"""Of the wrap factor in ISO 5292, which is 1 for half a turn."""
_BELTS, _OF_BELTS = (1.0, 3.0, 6.0, 999.0), (1.0, 0.95, 0.90, 0.85)
"""Number of V-belts side by side and its factor, by the help of a CAD system (Autodesk Inventor, V-belts)."""
_PULLEYS, _OF_PULLEYS = (2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 100.0), (1.0, 0.91, 0.86, 0.81, 0.78, 0.76, 0.75, 0.70)
"""Number of pulleys, idlers among them, and its factor; source as of belts."""
TENSION_FORMULAS = MappingProxyType({"Optibelt": 2.02, "GB/T 13575.1": 2.5})
"""Constant k of the tension at rest (k / c - 1) F / 2 + m v^2, with the wrap factor c, ascending: Optibelt, Technical
Manual V-Belt Drives, and the standard, which requires half as much again."""

NEW, RUN_IN = 1.5, 1.3
"""Tension at rest of a new and of a run-in belt over the least one that carries the load (GB/T 13575.1)."""


class RatingLaw(NamedTuple):
    """Coefficients of the rating law, of a belt or rib."""

    force: float
    """c1, N."""
    bending: float
    """c2, N m."""
    centrifugal: float
    """c3, kg/m."""
    speed: float
    """c4, N."""


def rated_force(law: RatingLaw, diameter: FloatArray | float, speed: float) -> FloatArray:
    """Rated pull of a belt on equal pulleys, N.

    Parameters
    ----------
    law : RatingLaw
    diameter : array_like
        Of the tension line on the pulley, m.
    speed : float
        Of the belt, m/s, above zero.

    Examples
    --------
    >>> from beltdyn.theory.rating import RatingLaw, rated_force
    >>> wrapped = RatingLaw(1379.0, 79.65, 0.1619, 160.8)  # SPA
    >>> speed = 0.05 * 104.72  # at 1000 rpm
    >>> round(float(rated_force(wrapped, 0.1, speed) * speed))  # W; its table has 2410
    2421
    """
    require_above(diameter=diameter, speed=speed)
    lost = law.bending / np.asarray(diameter) + law.centrifugal * speed**2 + law.speed * np.log10(speed)
    return np.asarray(law.force - lost)


@np.errstate(under="ignore")  # below the least number is zero
def ratio_factor(ratio: FloatArray | float, exponent: float) -> FloatArray:
    """Equivalent diameter K of two pulleys over the smaller diameter, for a ratio of the diameters of at least 1."""
    require_at_least(1.0, ratio=ratio)
    require_above(exponent=exponent)
    return np.asarray((2.0 / (1.0 + np.asarray(ratio) ** -exponent)) ** (1.0 / exponent))


def ratio_force(law: RatingLaw, diameter: FloatArray | float, ratio: FloatArray | float, exponent: float) -> FloatArray:
    """What the rated pull gains where the other pulley is larger by the ratio, N."""
    require_above(diameter=diameter)
    return np.asarray(law.bending / np.asarray(diameter) * (1.0 - 1.0 / ratio_factor(ratio, exponent)))


@np.errstate(under="ignore")  # below the least number is zero
def wrap_factor(wrap: FloatArray | float) -> FloatArray:
    """Factor on the rated power for a wrap angle in rad: 1 for half a turn, 0.82 for 120 degrees (ISO 5292)."""
    require_at_least(wrap=wrap)
    return np.asarray(_HALF_TURN * (1.0 - _BASE ** (-np.asarray(wrap) / pi)))


def belts_factor(belts: float) -> float:
    """Factor for unequal shares of V-belts side by side."""
    return float(np.interp(belts, _BELTS, _OF_BELTS))


def pulleys_factor(pulleys: int) -> float:
    """Factor for the bends by all pulleys of a drive."""
    return float(np.interp(pulleys, _PULLEYS, _OF_PULLEYS))


def least_tension(
    pull: float, wrap: float, mass: float, speed: float, grip: float = TENSION_FORMULAS["GB/T 13575.1"]
) -> float:
    """Tension of a belt at rest that carries a pull, by a formula of `TENSION_FORMULAS`, N.

    Parameters
    ----------
    pull : float
        Design power over belt speed, N.
    wrap : float
        Smallest wrap angle of a loaded pulley, rad.
    mass : float
        Per length, kg/m.
    speed : float
        Of the belt, m/s.
    grip : float, default 2.5
        Constant of the formula, by default that of GB/T 13575.1.

    Examples
    --------
    >>> from math import radians
    >>> from beltdyn.theory.rating import TENSION_FORMULAS, least_tension
    >>> pull = 1.3 * 132e3 / 21.76  # eight SPB, each of 0.19 kg/m; Optibelt prints 593 N a belt
    >>> round(least_tension(pull, radians(180), 8 * 0.19, 21.76, TENSION_FORMULAS["Optibelt"]) / 8)
    593
    """
    require_above(wrap=wrap)
    factor = float(wrap_factor(wrap))
    return 0.5 * pull * (grip / factor - 1.0) + mass * speed**2


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
    >>> from beltdyn.theory.rating import mesh_factor
    >>> mesh_factor([4.9, 7.2], most=6).round(3).tolist()
    [0.667, 1.0]
    """
    require_at_least(pitches=pitches)
    require_above(most=most)
    return np.asarray(np.minimum(whole_teeth(pitches) / most, 1.0))


def speed_factor(speed: ArrayLike, loss: float, reference: float) -> FloatArray:
    """Allowed load of a tooth over that at rest: 1 - loss * lg(1 + n / n_0), with the speeds of pulley and reference.

    Examples
    --------
    >>> from beltdyn.theory.rating import speed_factor
    >>> (24.7 * speed_factor([0.0, 1500.0, 10000.0], 0.324, 93.0)).round(1).tolist()  # tabulated: 24.7, 15.0, 8.4
    [24.7, 14.8, 8.4]
    """
    require_above(reference=reference)
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

"""The nip of two rollers (Johnson 1985, Contact Mechanics, 4.2 and 4.3).

On elastic foundations K the pressure is the parabola K (d - x^2 / 2 R), of solid rollers it is Hertz's half ellipse.
With the overlap y = d - x^2 / 2 R of the undeformed rollers, that is E* sqrt(y / 2 R) at each place: a local law, by
which the line force f compresses by A f^2, A = 2 R / (b E*)^2. Width, pressure and force are those of Hertz; the
approach of the centers is d = a^2 / 2 R, while that of half spaces grows with the logarithm of their size.

Hysteresis loss per meter of belt: bending onto and off a pulley, tension, compression.

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

from math import asin, inf, pi, sqrt
from typing import Final

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.ranges import require_above, require_at_least, require_at_most

_POINTS = 24
"""Of quadrature over a nip."""


def cover_modulus(youngs_modulus: float, poissons_ratio: float) -> float:
    """Modulus of a layer on a rigid core that cannot expand sideways, Pa.

    Examples
    --------
    >>> round(bd.theory.nip.cover_modulus(4e6, 0.45) / 4e6, 3)
    3.793
    """
    nu = poissons_ratio
    if not -1.0 < nu < 0.5:
        raise ModelError(f"poissons_ratio = {nu:g} is outside the range of this closed form, from -1 to below 0.5.")
    return youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def series(*stiffnesses: float) -> float:
    """Stiffness of springs in series; infinite ones do not give way.

    Examples
    --------
    >>> bd.theory.nip.series(3.0, 6.0)
    2.0
    """
    require_above(stiffness=[one for one in stiffnesses if one != inf])
    compliance = sum(0.0 if one == inf else 1.0 / one for one in stiffnesses)
    return inf if compliance == 0.0 else 1.0 / compliance


def equivalent_radius(*radii: float) -> float:
    """Radius of a roller on a plane that opens as two rollers do, 1 / (1 / R_1 + 1 / R_2), m.

    Examples
    --------
    >>> bd.theory.nip.equivalent_radius(0.1, 0.1)
    0.05
    """
    require_above(radii=[one for one in radii if one != inf])
    return 1.0 / sum(1.0 / one for one in radii)


def half_width(indentation: float, radius: float) -> float:
    """Half of the width of the nip, a = sqrt(2 R d), m.

    Parameters
    ----------
    indentation
        d, by how much the undeformed rollers overlap, m.
    radius
        R, of `equivalent_radius`, m.

    Examples
    --------
    >>> bd.theory.nip.half_width(5e-4, 0.1)
    0.01
    """
    require_at_least(indentation=indentation, radius=radius)
    return sqrt(2.0 * radius * indentation)


def plane_modulus(youngs_modulus: float, poissons_ratio: float) -> float:
    """Modulus of a solid roller in plane strain, E / (1 - nu^2), Pa.

    Examples
    --------
    >>> round(bd.theory.nip.plane_modulus(206e9, 0.3) / 1e9, 1)
    226.4
    """
    if not -1.0 < poissons_ratio <= 0.5:
        raise ModelError(f"poissons_ratio = {poissons_ratio:g} is outside the range of this closed form, -1 to 0.5.")
    return youngs_modulus / (1.0 - poissons_ratio**2)


def hertz_compliance(modulus: float, radius: float, width: float) -> float:
    """Compression of solid rollers over the square of the line force, A = 2 R / (b E*)^2, m^3/N^2.

    Parameters
    ----------
    modulus
        E*, of both rollers in series, Pa; infinite of rigid ones.
    radius
        R, of `equivalent_radius`, m.
    width
        b, m.

    Examples
    --------
    >>> bd.theory.nip.hertz_compliance(1e8, 0.05, 0.2)
    2.5e-16
    """
    require_above(width=width)
    if not modulus > 0.0:  # rigid rollers have an infinite one
        raise ModelError(f"modulus = {modulus:g} is outside the range of this closed form: it must be above 0.")
    return 2.0 * radius / (width * modulus) ** 2


def hertz_half_width(load: float, modulus: float, radius: float) -> float:
    """Half of the width of Hertz's line contact under a force per width (N/m), a = sqrt(4 F R / pi E*), m.

    The pressure is a half ellipse with the peak 2 F / pi a; `modulus` and `radius` are those of `hertz_compliance`.

    Examples
    --------
    >>> round(bd.theory.nip.hertz_half_width(10e3, 1e8, 0.05) * 1e3, 3)  # mm
    2.523
    """
    require_at_least(load=load, radius=radius)
    require_above(modulus=modulus)
    return sqrt(4.0 * load * radius / (pi * modulus))


def line_force(overlap: float | FloatArray, stiffness: float, hertz: float = 0.0) -> FloatArray:
    """Line force f that compresses a foundation and solid rollers in series by f / K + A f^2, N/m.

    Examples
    --------
    >>> float(bd.theory.nip.line_force(2e-3, 1e9, 1e-15))
    1000000.0
    """
    require_at_least(stiffness=stiffness, hertz=hertz)
    overlap = np.maximum(overlap, 0.0)  # apart there is no force
    return np.asarray(2.0 * stiffness * overlap / (1.0 + np.sqrt(1.0 + 4.0 * hertz * stiffness**2 * overlap)))


def force(indentation: float, stiffness: float, radius: float, hertz: float = 0.0) -> float:
    """Force of a foundation of stiffness K (N/m^2 over the length of the belt), F = 4 K a d / 3, N.

    The line force is the parabola K (d - x^2 / 2 R); `indentation` and `radius` are those of `half_width`. With the
    compliance A of solid rollers (`hertz_compliance`) in series, `line_force` is integrated over x = a sin u.

    Examples
    --------
    >>> round(bd.theory.nip.force(5e-4, 3e8, 0.1), 6)
    2000.0
    """
    half = half_width(indentation, radius)
    if hertz == 0.0:
        return 4.0 / 3.0 * stiffness * half * indentation
    place, weight = np.polynomial.legendre.leggauss(_POINTS)
    opening = np.cos(0.25 * pi * (place + 1.0))
    loads = line_force(indentation * opening**2, stiffness, hertz)
    return float(0.5 * pi * half * np.sum(weight * opening * loads))


def indentation_of(load: float, stiffness: float, radius: float, hertz: float = 0.0) -> float:
    """Indentation d under a force (N), m; the inverse of `force`.

    Examples
    --------
    >>> round(bd.theory.nip.indentation_of(2000.0, 3e8, 0.1), 9)
    0.0005
    """
    require_above(stiffness=stiffness, radius=radius)
    require_at_least(load=load, hertz=hertz)
    soft = float((3.0 * load / (4.0 * stiffness * sqrt(2.0 * radius))) ** (2.0 / 3.0))
    if hertz == 0.0:
        return soft
    from scipy.optimize import brentq

    beyond = soft + 4.0 * load * sqrt(0.5 * hertz / radius) / pi
    return float(brentq(lambda depth: force(depth, stiffness, radius, hertz) - load, soft, beyond, xtol=1e-15))


def nip_damping(loss_factor: float, half_width: float, speed: float, solid: float = 0.0) -> float:
    """Damping over stiffness of a foundation that loses in a nip what hysteresis does, s.

    A strip is pressed to d = a^2 / 2 R at the rate v x / R. Hysteresis loses pi / 2 eta of the energy K d^2 / 2 of a
    foundation, and of 2 A f^3 / 3 of solid rollers, by which they lose eta F a / 3 R (Johnson 1985, 9.1). A damper
    does so with about 3 pi eta a / 32 v and eta a / 3 v; it lets go before the rollers do, which is taken into account.

    Parameters
    ----------
    loss_factor
        eta, tan delta.
    half_width
        a, m.
    speed
        v, m/s; at a standstill there is none.
    solid
        Part of the energy that solid rollers store.

    Examples
    --------
    >>> round(bd.theory.nip.nip_damping(0.1, 0.01, 2.0) * 1e3, 4)  # ms
    0.1506
    """
    require_at_least(loss_factor=loss_factor, half_width=half_width, speed=speed, solid=solid)
    require_at_most(2.0, loss_factor=loss_factor)
    require_at_most(1.0, solid=solid)
    if speed == 0.0 or loss_factor == 0.0:
        return 0.0
    from scipy.optimize import brentq

    def excess(delay: float) -> float:
        linear, curved = (_damper_loss(delay, power) for power in (1.0, 0.5))
        return (1.0 - solid) * (linear - 0.25 * pi * loss_factor) + solid * (curved - pi / 3.0 * loss_factor)

    return float(brentq(excess, 0.0, 2.0 * loss_factor)) * half_width / speed


def _damper_loss(delay: float, power: float) -> float:
    """What a damper loses of the peak line force times d, with the line force as a power of d + delay d' a / v."""
    reach = sqrt(1.0 + delay**2)
    first = asin((delay - 1.0) / reach)
    place, weight = np.polynomial.legendre.leggauss(_POINTS)
    angle = first + 0.5 * (0.5 * pi - first) * (place + 1.0)
    load, along = (reach * np.cos(angle)) ** (2.0 * power), reach * np.sin(angle) - delay
    return float(-(0.5 * pi - first) * np.sum(weight * load * along * reach * np.cos(angle)))


def rolling_loss(loss_factor: float, stiffness: float, indentation: float) -> float:
    """Force that hysteresis takes to roll a foundation K (N/m^2) through a nip, pi / 4 eta K d^2, N.

    Examples
    --------
    >>> round(bd.theory.nip.rolling_loss(0.1, 3e8, 5e-4), 2)
    5.89
    """
    return 0.25 * pi * loss_factor * stiffness * indentation**2


BENDING_SHARE: Final = 0.25 * pi
"""Modulus of hysteresis over the loss factor and the stiffness, where a strain goes from the reference and back."""

STRETCH_SHARE: Final = 0.5 * pi
"""The same where a strain goes as far to one side of the reference as to the other."""


def bending_loss(bending_stiffness: float, loss_factor: float, radii: FloatArray) -> FloatArray:
    """Bending loss per meter of belt on each pulley, J/m, equal to a resisting force in N."""
    require_above(radii=radii)
    return np.asarray(BENDING_SHARE * loss_factor * bending_stiffness / np.asarray(radii) ** 2)


def stretch_loss(axial_stiffness: float, loss_factor: float, tight: float, slack: float) -> float:
    """Loss per meter of belt over a tension cycle from slack to tight and back, J/m."""
    require_above(axial_stiffness=axial_stiffness)
    return BENDING_SHARE * loss_factor * (tight - slack) ** 2 / axial_stiffness


def deepest(stiffness: float) -> float:
    """Penetration at the ends of an arc over that along the arc."""
    require_at_least(stiffness=stiffness)
    if stiffness == 0.0:  # a string
        return 1.0
    first, second = np.roots([1.0, -1.0, stiffness * (1.0 + 1e-9)])  # squares of the rates of decay, in sqrt(T / E I)
    rates = np.sqrt(np.array([first, second], dtype=complex))
    parts = np.linalg.solve([np.ones(2), rates**2 + rates**3], [-1.0, -stiffness])
    along = np.linspace(0.0, 12.0, 2001) / np.abs(rates).mean()
    return float(np.max(1.0 + (parts @ np.exp(-np.outer(rates, along))).real, initial=1.0))


def compression_loss(
    tension: float, bending_stiffness: float, contact_stiffness: float, loss_factor: float, radii: FloatArray
) -> FloatArray:
    """Compression loss per meter of belt on each pulley, J/m."""
    require_above(tension=tension, contact_stiffness=contact_stiffness, radii=radii)
    depth = deepest(bending_stiffness * contact_stiffness / tension**2)
    energy = (2.0 * depth**2 - 1.0) * tension**2 / contact_stiffness
    return np.asarray(BENDING_SHARE * loss_factor * energy / np.asarray(radii) ** 2)

"""Spans and circular arcs of a tight string.

A span between its pulleys: lowest frequency with sag, and the force that deflects it.

Frequency (Irvine and Caughey 1974).  A parabola between ends that hold it is stretched as it swings, since it sags.
With the weight w per length across it

    lambda^2 = (w l / T)^2 l EA / (T L),        L = l (1 + (w l / T)^2 / 8),
    tan(k / 2) = k / 2 - 4 / lambda^2 (k / 2)^3,        omega^2 = (T + EI (k / l)^2) (k / l)^2 / m,

where k, the first root, belongs to the symmetric swing: pi without sag, and up to 3 pi.  The antisymmetric one,
k = 2 pi, does not stretch the span, and is the lowest from lambda = 2 pi on.

Force.  With the tension T, the bending stiffness EI and u = l/2 sqrt(T / EI), a force F deflects the middle by

    w = F l / 4T (1 - tanh(u) / u),

which is F l / 4T of a string for large u, and F l^3 / 48 EI of a beam for small u. A span between fixed centers is
stretched by 2 w^2 / l, as by a bent line of two straight halves.
"""

from math import asin, cos, pi, sin, sqrt, tanh
from typing import NamedTuple

from beltdyn.errors import ModelError
from beltdyn.parts.ranges import require_above, require_at_least

_SMALLEST = 1e-12
"""lambda^2 below which a span is straight."""
_SMALL = 1e-3
"""u below which 1 - tanh(u) / u is its series, u^2 / 3."""


def sag_parameter(weight: float, length: float, tension: float, axial_stiffness: float) -> float:
    """Irvine's parameter lambda^2 for the stiffening by sag, 1."""
    require_above(length=length, tension=tension)
    require_at_least(weight=weight, axial_stiffness=axial_stiffness)
    sag = weight * length / tension
    return sag**2 * axial_stiffness / (tension * (1.0 + sag**2 / 8.0))


def sag_ratio(weight: float, length: float, tension: float) -> float:
    """Sag of a shallow span over its length, w l / 8 T, with the weight w across it, N/m.

    Examples
    --------
    >>> from beltdyn.theory.span import sag_ratio
    >>> sag_ratio(1000.0, 1.2, 15e3)
    0.01
    """
    require_above(tension=tension)
    return weight * length / (8.0 * tension)


def lowest_frequency(
    length: float, tension: float, mass: float, *, bending: float = 0.0, sag_parameter: float = 0.0
) -> float:
    """Lowest frequency of transverse vibration of a span in its plane, Hz."""
    require_above(length=length, mass=mass)
    require_at_least(tension=tension, bending=bending)
    wave = min(symmetric_root(sag_parameter), 2.0 * pi) / length
    return wave * sqrt((tension + bending * wave**2) / mass) / (2.0 * pi)


def symmetric_root(sag_parameter: float) -> float:
    """First root k of the symmetric swing, between pi and 3 pi, by bisection."""
    require_at_least(sag_parameter=sag_parameter)
    if sag_parameter < _SMALLEST:
        return pi
    low, high = 0.5 * pi, 1.5 * pi
    for _ in range(60):
        half = 0.5 * (low + high)
        excess = sin(half) - (half - 4.0 / sag_parameter * half**3) * cos(half)
        low, high = (half, high) if excess > 0.0 else (low, half)
    return low + high


def deflection_force(deflection: float, length: float, tension: float, bending: float = 0.0) -> float:
    """Force across the middle of a span that deflects it, N.

    Parameters
    ----------
    deflection : float
        Of the middle, m.
    length : float
        Of the span, m.
    tension : float
        N.
    bending : float, default 0
        Bending stiffness, N m^2.

    Examples
    --------
    >>> from beltdyn.theory.span import deflection_force
    >>> deflection_force(0.01, 0.5, 200.0)  # 4 T w / l of a string
    16.0
    """
    require_above(length=length, tension=tension)
    return 4.0 * tension * deflection / length / _flexibility(length, tension, bending)


def stretching(deflection: float, length: float) -> float:
    """How much longer a span becomes by a deflection of its middle, m."""
    require_above(length=length)
    return 2.0 * deflection**2 / length


def _flexibility(length: float, tension: float, bending: float) -> float:
    """1 - tanh(u) / u."""
    if not bending > 0.0:
        return 1.0
    half = 0.5 * length * sqrt(tension / bending)
    return half**2 / 3.0 if half < _SMALL else 1.0 - tanh(half) / half


def hoop_tension(mass_per_length: float, speed: float) -> float:
    """Centrifugal tension T = rho A v^2 (Routh 1860) of a running belt without contact.

    Examples
    --------
    >>> bd.theory.span.hoop_tension(mass_per_length=0.1, speed=20.0)
    40.0
    """
    return mass_per_length * speed**2


def hoop_stretch(
    transport_speed: float,
    axial_stiffness: float,
    mass_per_length: float,
    *,
    bending_stiffness: float = 0.0,
    turning: float = 0.0,
) -> float:
    """Stretch g of a spinning hoop by Green's strain, exactly: g^2 = 1 + (2 rho A c^2 - 3 EI kappa^2) / EA.

    With v = c g and rho A / g kg in a running meter the hoop tension is rho A c^2 g.  The belt carries it by stretch,
    EA (g^2 - 1) g / 2, and, as it was straight unstressed, by bending, 3/2 EI kappa^2 g (Eq. 14).

    Examples
    --------
    >>> round(bd.theory.span.hoop_stretch(20.0, axial_stiffness=1e5, mass_per_length=0.1), 6)
    1.0004
    """
    require_above(axial_stiffness=axial_stiffness)
    inertia = 2.0 * mass_per_length * transport_speed**2
    square = 1.0 + (inertia - 3.0 * bending_stiffness * turning**2) / axial_stiffness
    require_above(square_of_stretch=square)
    return sqrt(square)


class OpenBelt(NamedTuple):
    """Path of an open (not crossed) belt around two pulleys."""

    span: float
    """Length of each span, m."""
    tilt: float
    """Angle between the spans and the line of centers, positive towards the second pulley, rad."""
    wrap: tuple[float, float]
    """Wrap angles, rad."""
    length: float
    """m."""


def open_belt(distance: float, radii: tuple[float, float]) -> OpenBelt:
    """Path of length 2 D cos b + R1 (pi - 2 b) + R2 (pi + 2 b) around two pulleys, sin b = (R2 - R1) / D.

    Examples
    --------
    >>> round(bd.theory.span.open_belt(distance=0.4, radii=(0.05, 0.1)).length, 4)
    1.2775
    """
    require_at_least(radius=radii)
    if not distance >= abs(radii[1] - radii[0]):
        raise ModelError(
            f"distance = {distance:g} m is less than the difference of the radii, {radii[0]:g} and {radii[1]:g} m: a "
            "pulley lies in the other. Increase the distance."
        )
    tilt = asin((radii[1] - radii[0]) / distance) if radii[1] != radii[0] else 0.0
    span = sqrt(distance**2 - (radii[1] - radii[0]) ** 2)
    wrap = (pi - 2.0 * tilt, pi + 2.0 * tilt)
    return OpenBelt(span, tilt, wrap, 2.0 * span + radii[0] * wrap[0] + radii[1] * wrap[1])


_CLEAR = 1.05
"""Least center distance over that of touching pulleys."""


def center_distance(length: float, radii: tuple[float, float]) -> float | None:
    """Center distance at which the path around two pulleys has a length, m; None if the pulleys would touch.

    By Newton's method: the path grows by twice the cosine of the tilt.

    Examples
    --------
    >>> round(bd.theory.span.center_distance(1.2775, radii=(0.05, 0.1)), 3)
    0.4
    """
    least = _CLEAR * sum(radii)
    if open_belt(least, radii).length > length:
        return None
    distance = 0.5 * (length - pi * sum(radii))
    for _ in range(20):
        path = open_belt(max(distance, least), radii)
        step = (length - path.length) / (2.0 * cos(path.tilt))
        distance = max(distance, least) + step
        if abs(step) < 1e-12:
            break
    return distance

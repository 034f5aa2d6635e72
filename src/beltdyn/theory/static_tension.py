"""Tension of a belt at rest on pulleys of penalty contact: stretch, penetration, ends of contact."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.parts.messages import beyond
from beltdyn.parts.ranges import require_above, require_at_least
from beltdyn.stretch import StretchParameters
from beltdyn.theory.span import open_belt

_DEEPEST = 0.15
"""Largest tension over k_p R^2 considered; above 1/6, a penetration of R/3, there is no equilibrium."""


class StaticTension(NamedTuple):
    """A belt at rest around two pulleys."""

    tension: float
    """T in the spans, N."""
    arc_tension: tuple[float, float]
    """T in the middle of each arc, N."""
    penetration: tuple[float, float]
    """d there, m."""
    path: float
    """Length of the stretched belt, m."""


def static_tension(
    length: float,
    distance: float,
    radii: tuple[float, float],
    *,
    law: StretchParameters,
    contact_stiffness: float,
    bending_stiffness: float = 0.0,
) -> StaticTension:
    """Tension at which the stretched belt has the length of its path around two pulleys.

    On the arcs the belt presses with k_p d = T g / (R - d) per reference length.  There the tension is that of the
    spans, T0, plus k_p d^2 / 2 g, since a radial force does work on a belt that sinks in, less 2 EI kappa^2 for
    bending.

    The path is that around circles of R - d, and longer at every end of contact, where the belt rises to the rim and
    becomes straight: by 5/12 d lambda / R with lambda^2 = d (R - d) for penetration, by beta^3 / 12 R^2 with
    beta^2 = EI / T0 for bending.

    Examples
    --------
    >>> from beltdyn.stretch import Linear
    >>> from beltdyn.theory.static_tension import static_tension
    >>> round(static_tension(1.295, 0.4, (0.08, 0.08), law=Linear(1e4), contact_stiffness=1e8).tension, 2)
    58.75
    """
    from scipy.optimize import brentq

    require_above(length=length, contact_stiffness=contact_stiffness)
    require_at_least(bending_stiffness=bending_stiffness)
    section = Section(law, contact_stiffness, bending_stiffness)
    belt = _Belt(length, distance, radii, section)
    rigid = float(law.tension(open_belt(distance, radii).length / length))
    most = min(1.1 * rigid, _DEEPEST * contact_stiffness * min(radii) ** 2)
    least = max(1e-3 * most, 4.0 * bending_stiffness / min(radii) ** 2)
    if not least < most or _path(belt, least)[1] < length:
        raise ModelError(
            f"length = {length:g} m is too long: around pulleys of {radii[0]:g} and {radii[1]:g} m at {distance:g} m "
            "the belt is slack, or too stiff in bending to follow them. Shorten it."
        )
    if _path(belt, most)[1] > length:
        raise ModelError(
            f"contact_stiffness = {contact_stiffness:g} N/m^2 is too soft for a belt of {length:g} m: it sinks in by "
            f"more than {_DEEPEST:.0%} of the radius. Increase it, or lengthen the belt."
        )
    found = float(brentq(lambda tension: _path(belt, tension)[1] - length, least, most))
    one, other = (arc_at_rest(section, found, radius) for radius in radii)
    return StaticTension(found, (one.tension, other.tension), (one.depth, other.depth), _path(belt, found)[0])


class _Belt(NamedTuple):
    """The arguments of `static_tension`."""

    length: float
    distance: float
    radii: tuple[float, float]
    section: "Section"


class Section(NamedTuple):
    """What a belt is made of, and how hard its contact is."""

    law: StretchParameters
    contact: float
    """N/m^2."""
    bending: float
    """N m^2."""


class ArcAtRest(NamedTuple):
    """A belt in the middle of its arc on a pulley."""

    tension: float
    """N."""
    stretch: float
    depth: float
    """Penetration, m."""


def _path(belt: _Belt, tension: float) -> tuple[float, float]:
    """Length of the path under a tension of the spans, and unstretched length of the belt on it, m."""
    arcs = [arc_at_rest(belt.section, tension, radius) for radius in belt.radii]
    inner = belt.radii[0] - arcs[0].depth, belt.radii[1] - arcs[1].depth
    way = open_belt(belt.distance, inner)
    ends = sum(
        2 * end_of_contact(arc.depth, radius, belt.section.bending / tension)
        for arc, radius in zip(arcs, inner, strict=True)
    )
    unstretched = (2 * way.span + ends) / float(belt.section.law.stretch(tension))
    for arc, radius, wrap in zip(arcs, inner, way.wrap, strict=True):
        unstretched += radius * wrap / arc.stretch
    return way.length + ends, unstretched


def arc_at_rest(section: Section, tension: float, radius: float) -> ArcAtRest:
    """Depth, stretch and tension in the middle of an arc, under a tension of the spans (N), on a radius (m).

    What the depth adds to the tension converges like d / R. ModelError where the belt is too stiff to follow the
    radius, or contact too soft to hold it.
    """
    require_above(tension=tension, radius=radius)
    here, depth = tension, 0.0
    for _ in range(50):
        if here < 0.0:
            raise ModelError(
                f"a tension of {tension:.4g} N does not bend the belt around a radius of {1e3 * radius:.4g} mm: its "
                f"bending stiffness of {section.bending:.4g} N m^2 takes {2.0 * section.bending / radius**2:.4g} N. "
                "Reduce the bending stiffness or the thickness, or increase the tension or the radius."
            )
        g = float(section.law.stretch(here))
        left = radius**2 - 4.0 * here * g / section.contact
        if left < 0.0:
            raise ModelError(
                f"a contact stiffness of {section.contact:.4g} N/m^2 does not hold a belt with {here:.4g} N on a "
                f"radius of {1e3 * radius:.4g} mm: the belt sinks in by more than half of it. Give at least "
                f"{beyond(section.contact, 4.0 * here * g / radius**2):.2g} N/m^2."
            )
        depth = 0.5 * (radius - sqrt(left))
        here = tension + 0.5 * section.contact * depth**2 / g - 2.0 * section.bending / (radius - depth) ** 2
    return ArcAtRest(here, float(section.law.stretch(here)), depth)


def end_of_contact(depth: float, radius: float, bend: float) -> float:
    """What an end of contact adds to the path around a radius inside of the penetration, m; bend is EI / T0, m^2."""
    require_above(radius=radius)
    require_at_least(depth=depth, bend=bend)
    return float(5 / 12 * depth * (radius * depth) ** 0.5 / radius + bend**1.5 / (12 * radius**2))


def span_radius(depth: float, radius: float, bend: float, wrap: float) -> float:
    """Radius of the circle around the center of a pulley that the lines of its straight spans touch, m.

    Without friction the moment of tension T and bending moment M about the center is the same along the belt. With that
    in the middle of the arc, of curvature 1/R and with T_a = T + k_p d^2 / 2 - EI / 2 R^2 and M = EI / R,

        R_s = R - d / 2 + EI / 2 T R.

    A wrap angle below 2 l / R with l^2 = EI / T is too small for this curvature. The belt touches the rim at a point,
    bends there by wrap / 2 to both sides within l, and R_s = R cos(wrap / 2) + l sin(wrap / 2), to second order

        R_s = R - d / 2 + l a - R a^2 / 2,   a = min(wrap / 2, l / R),

    which is both.

    Parameters
    ----------
    depth : float
        Penetration d, m.
    radius : float
        R of the pulley, m.
    bend : float
        EI / T, m^2.
    wrap : float
        Angle between the spans, rad.

    Examples
    --------
    >>> from beltdyn.theory.static_tension import span_radius
    >>> span_radius(0.0, 0.05, 4e-6, wrap=3.0)  # EI / 2 T R = 0.04 mm
    0.05004
    """
    require_above(radius=radius)
    require_at_least(bend=bend)
    length = sqrt(bend)
    bent = min(0.5 * wrap, length / radius)
    return radius - 0.5 * depth + bent * (length - 0.5 * radius * bent)


def stretch_with_penetration(length: float, path: float, law: StretchParameters, sinking: float) -> float:
    """Stretch g of a belt at rest with penetration: the root of g length + sinking T g = path, T of g.

    Examples
    --------
    >>> from beltdyn.stretch import Linear
    >>> round(bd.theory.static_tension.stretch_with_penetration(1.0, 1.01, Linear(1e4), sinking=1e-5), 6)
    1.009083
    """
    require_above(length=length)
    require_at_least(length, path=path)
    require_at_least(sinking=sinking)
    lower, upper = 1.0, path / length
    g = upper
    while True:
        force = float(law.tension(g))
        excess = g * length + sinking * force * g - path
        lower, upper = (lower, g) if excess > 0.0 else (g, upper)
        slope = length + sinking * (force + float(law.tangent_stiffness(g)) * g)
        ahead = g - excess / slope
        if not lower < ahead < upper:
            ahead = 0.5 * (lower + upper)
        if abs(ahead - g) <= np.finfo(float).eps * g:
            return ahead
        g = ahead

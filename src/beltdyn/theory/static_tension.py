"""Tension of a belt at rest on pulleys of penalty contact: stretch, penetration, ends of contact."""

from typing import NamedTuple

from beltdyn.errors import ModelError
from beltdyn.stretch import StretchParameters
from beltdyn.theory.path import open_belt

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

    belt = _Belt(length, distance, radii, law, contact_stiffness, bending_stiffness)
    rigid = float(law.tension(open_belt(distance, radii).length / length))
    most = min(1.1 * rigid, _DEEPEST * contact_stiffness * min(radii) ** 2)
    least = max(1e-3 * most, 4.0 * bending_stiffness / min(radii) ** 2)
    if not least < most or _path(belt, least)[1] < length:
        raise ModelError(
            f"length = {length:g} m is too long: around pulleys of {radii[0]:g} and {radii[1]:g} m at {distance:g} m "
            "the belt is slack, or too stiff in bending to follow them. Shorten it."
        )
    found = float(brentq(lambda tension: _path(belt, tension)[1] - length, least, most))
    one, other = _arcs(belt, found)
    return StaticTension(found, (one.tension, other.tension), (one.depth, other.depth), _path(belt, found)[0])


class _Belt(NamedTuple):
    """The arguments of `static_tension`."""

    length: float
    distance: float
    radii: tuple[float, float]
    law: StretchParameters
    contact: float
    bending: float


class _Arc(NamedTuple):
    """A belt in the middle of its arc on a pulley."""

    tension: float
    stretch: float
    depth: float


def _path(belt: _Belt, tension: float) -> tuple[float, float]:
    """Length of the path under a tension of the spans, and unstretched length of the belt on it, m."""
    arcs = _arcs(belt, tension)
    inner = belt.radii[0] - arcs[0].depth, belt.radii[1] - arcs[1].depth
    way = open_belt(belt.distance, inner)
    ends = sum(2 * _end(arc.depth, radius, belt.bending / tension) for arc, radius in zip(arcs, inner, strict=True))
    unstretched = (2 * way.span + ends) / float(belt.law.stretch(tension))
    for arc, radius, wrap in zip(arcs, inner, way.wrap, strict=True):
        unstretched += radius * wrap / arc.stretch
    return way.length + ends, unstretched


def _arcs(belt: _Belt, tension: float) -> tuple[_Arc, _Arc]:
    """Both arcs under a tension of the spans."""
    return _arc(belt, tension, belt.radii[0]), _arc(belt, tension, belt.radii[1])


def _arc(belt: _Belt, tension: float, radius: float) -> _Arc:
    """Depth, stretch and tension on an arc; what the depth adds to the tension converges like d / R."""
    here, depth = tension, 0.0
    for _ in range(50):
        g = float(belt.law.stretch(here))
        depth = 0.5 * (radius - (radius**2 - 4.0 * here * g / belt.contact) ** 0.5)
        here = tension + 0.5 * belt.contact * depth**2 / g - 2.0 * belt.bending / (radius - depth) ** 2
    return _Arc(here, float(belt.law.stretch(here)), depth)


def _end(depth: float, radius: float, bend: float) -> float:
    """What an end of contact adds to the path, m; bend is EI / T0, m^2."""
    return float(5 / 12 * depth * (radius * depth) ** 0.5 / radius + bend**1.5 / (12 * radius**2))

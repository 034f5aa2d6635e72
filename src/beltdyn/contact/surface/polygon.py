"""Pulleys with teeth on whose lands the belt bends, and runs straight over the grooves: a polygon.

Lands are cylinders of the radius r of the tension line.  With z grooves and the effective radius R, straight pieces of
the length e = 2 pi (R - r) / z make a turn of the belt as long as that of the circle, 2 pi R.  A belt that does not
bend leaves with the speed

    omega (r + e cos(phi) / (2 sin(pi / z))),    |phi| < pi / z,

whose ripple is 1 - cos(pi / z) where r is small; r = R is the circle.
"""

from math import atan2, cos, floor, hypot, sin
from typing import NamedTuple

from beltdyn.contact.surface.kind import Gap
from beltdyn.contact.surface.toothed import ToothedRims
from beltdyn.kernel import kernel


class PolygonRims(ToothedRims):
    """Pulleys some of which have single teeth and lands of a radius, at the angles of a state."""


class Polygon(NamedTuple):
    """A pulley of a belt with single teeth that runs straight from land to land."""

    radius: float
    stiffness: float
    damping: float
    half_gap: float
    pitch_radius: float
    rate: float
    groove: float
    flank: float
    spacing: float
    height: float
    phase: float
    by_flow: float
    by_speed: float
    """All as of `Toothed`."""
    land: float
    """Radius of the lands r, m; that of the pulley, if it has no teeth."""
    corner: float
    """Distance of their centers from the shaft, m."""


@kernel
def polygon_at(rims: PolygonRims, pulley: int, angle: float, passed: float = 0.0) -> Polygon:
    """A pulley at an angle (rad), when a length of belt (m) has passed the mesh."""
    row, radius = rims.table[pulley], rims.radius[pulley]
    land = row.land if 0.0 < row.land < radius and row.stiffness > 0.0 else radius
    return Polygon(
        radius,
        row.stiffness,
        row.damping,
        row.half_gap,
        row.pitch_radius,
        row.rate,
        row.groove,
        row.flank,
        row.spacing,
        row.height,
        row.phase + angle - row.rate * passed,
        1.0,
        1.0,
        land,
        0.5 * row.groove * (radius - land) / sin(0.5 * row.groove),
    )


@kernel
def polygon_gap(surface: Polygon, x: float, y: float) -> Gap:
    """Gap of a point at x, y against the shaft (m): from the nearest land."""
    behind = floor((atan2(y, x) - surface.phase) / surface.groove)
    angle = surface.phase + (behind + 0.5) * surface.groove
    dx, dy = x - surface.corner * cos(angle), y - surface.corner * sin(angle)
    distance = hypot(dx, dy)
    return Gap(surface.land - distance, dx / distance, dy / distance, 1.0 / distance)


@kernel
def polygon_reach(surface: Polygon) -> float:
    """Distance of the lands from the shaft, or of the tops of teeth that reach out, m."""
    return max(surface.land + surface.corner, surface.radius + surface.height)


@kernel
def polygon_seat(surface: Polygon) -> float:
    """Distance from the shaft of a straight belt over the middle of a groove, m."""
    return surface.land + surface.corner * cos(0.5 * surface.groove)

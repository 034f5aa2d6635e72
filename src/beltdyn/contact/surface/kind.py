"""The contract of shaped pulley surfaces, and their register."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from beltdyn.contact.parameter import Parameter


class Gap(NamedTuple):
    """Position of a point relative to a surface."""

    penetration: float
    """Distance from the surface, m, positive inside."""
    normal_x: float
    """Unit normal of the surface at its nearest point, outward."""
    normal_y: float
    curvature: float
    """How the normal turns along the line through the point at that distance, 1/m: 1 / (R - d) of a circle."""


class SurfaceKind(NamedTuple):
    """A registered kind of surface."""

    name: str
    """Its name in a drive file."""
    gap: Callable[[float, float, float, Any], Gap]
    """Kernel: the gap of a point from its place x, y against the shaft in the frame that turns with the pulley (m), the
    effective radius (m), and the parameters as fields of a record."""
    reach: Callable[[Mapping[str, float]], float]
    """Largest deviation beyond the effective radius, m, from the parameters."""
    parameters: tuple[Parameter, ...]
    """Its keys in a drive file, and the fields of the record."""


KINDS: dict[str, SurfaceKind] = {}
"""All kinds of surfaces but the smooth circle, by their names."""


def register(kind: SurfaceKind) -> None:
    """Register a kind of surface."""
    KINDS[kind.name] = kind

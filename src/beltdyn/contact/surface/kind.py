"""The contract of shaped pulley surfaces, and their registry."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from beltdyn.kernel import KernelKinds
from beltdyn.kinds import Parameter
from beltdyn.records import record


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
    """A kind of pulley surface, for `register`."""

    name: str
    """Its name in a drive file."""
    gap: Callable[[Any, float, float, float], Gap]
    """Kernel: the gap of a point from the parameters as fields of a record, its place x, y against the shaft in the
    frame that turns with the pulley (m), and the effective radius (m)."""
    reach: Callable[[Mapping[str, float]], float]
    """Largest deviation beyond the effective radius, m, from the parameters."""
    parameters: tuple[Parameter, ...]
    """Its keys in a drive file, and the fields of the record."""

    @property
    def constants(self) -> np.dtype[np.void]:
        """The record of its parameters."""
        return record(**{parameter.name: "f8" for parameter in self.parameters} or {"unused": "f8"})


KINDS = KernelKinds[SurfaceKind]("surface", SurfaceKind)
"""All kinds of surfaces by their names."""

"""The contract of what carries a span between its pulleys: keys, constants, and resistance against motion."""

from collections.abc import Callable, Mapping
from math import tanh
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.kernel import KernelKinds, kernel
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, LineDamping, LineStiffness, Name


class LineForce(NamedTuple):
    """Force against the motion of the belt on a meter of a support, N/m, and its derivatives.

    Examples
    --------
    >>> from beltdyn.extend import LineForce
    >>> friction, normal = 0.02, 1200.0  # idlers under a loaded belt
    >>> LineForce(friction * normal, by_normal=friction, by_speed=0.0).force
    24.0
    """

    force: float
    by_normal: float
    by_speed: float
    """N s/m^2."""


@kernel(inline=True)
def dry_resistance(limit: float, friction: float, speed: float, creep_speed: float) -> LineForce:
    """Friction that reaches 76 % of its limit at the creep speed (m/s); the limit grows by friction with normal force.

    Parameters
    ----------
    limit
        N/m.
    friction
        Derivative of the limit by the normal force.
    speed, creep_speed
        m/s.
    """
    rise = tanh(speed / creep_speed)
    return LineForce(limit * rise, friction * rise, limit * (1.0 - rise * rise) / creep_speed)


class OnSpan(Part):
    """What lies along a span, or along a part of it."""

    span: tuple[Name, Name] = Field(description="the span, by the names of the pulleys at its start and its end")
    start: Coordinate = Field(0.0, ge=0, description="where it begins, from the start of the span, in m")
    end: Coordinate | None = Field(
        None, gt=0, description="where it ends, from the start of the span, in m; by default with the span"
    )

    @model_validator(mode="after")
    def _has_a_length(self) -> Self:
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"end = {self.end:g} m must lie behind start = {self.start:g} m. Exchange or omit them")
        return self


class Support(OnSpan):
    """What carries the belt along a span, spread evenly over its length.

    Examples
    --------
    >>> conveyor = bd.example("conveyor_1km")
    >>> [(one.kind, one.span, one.spacing) for one in conveyor.supports]
    [('idlers', ('tail', 'head'), 1.2), ('idlers', ('head', 'tail'), 3.0)]
    """

    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants; by default these are the fields of the same names."""
    resistance_at: ClassVar[Callable[[np.record, float, float], LineForce]]
    """Kernel: resistance from constants, normal force (N/m, at least zero) and speed of the belt (m/s)."""
    needs_weight: ClassVar[bool] = False
    """Whether it carries by weight alone, on the lower side of the belt."""

    if TYPE_CHECKING:
        kind: str

    stiffness: LineStiffness | None = Field(
        None,
        gt=0,
        description="the normal stiffness, in N/m^2; by default belt and goods sink in by a millimeter",
    )
    damping: LineDamping | None = Field(
        None, ge=0, description="the normal damping, in N*s/m^2; by default critical for the belt without goods"
    )
    curve_radius: Coordinate | None = Field(
        None,
        gt=0,
        description="the radius of a concave curve, whose center lies on the upper side, in m; by default straight",
    )

    def values(self, weight: float) -> Mapping[str, Any]:
        """Values of its constants; `weight` is that of a kg, m/s^2."""
        return {name: getattr(self, name) for name in self.constants.names or ()}

    @property
    def free_length(self) -> float:
        """Length over which the belt hangs between its parts, m."""
        return 0.0

    @property
    def rotating_mass(self) -> float:
        """Mass of rotating parts that move with the belt, kg/m."""
        return 0.0


SUPPORTS = KernelKinds[type[Support]]("support", Support)
"""All kinds of supports by name."""

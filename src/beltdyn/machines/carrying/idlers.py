"""Idlers, spread over a span: C f (n + m_R g) + r + l v against the motion (DIN 22101, main resistance)."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from pydantic import Field

from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.carrying.support import LineForce, Support, dry_resistance
from beltdyn.parts.quantity import Length, LineDamping, Mass, Ratio, Speed, Stiffness
from beltdyn.records import record

IDLERS = record(
    friction="f8",  # C f
    constant="f8",  # C f m_R g + r, N/m
    linear="f8",  # l, N s/m^2
    creep_speed="f8",  # m/s
)


@kernel
def idler_resistance(constants: np.record, normal: float, speed: float) -> LineForce:
    """Resistance of idlers.

    Parameters
    ----------
    constants
        A row of `IDLERS`.
    normal
        n, N/m.
    speed
        v, m/s.
    """
    limit = constants.friction * normal + constants.constant
    dry = dry_resistance(limit, constants.friction, speed, constants.creep_speed)
    return LineForce(dry.force + constants.linear * speed, dry.by_normal, dry.by_speed + constants.linear)


@register
class Idlers(Support):
    """A line of idlers under a span, spread over its length.

    Examples
    --------
    >>> line = bd.model.Idlers(kind="idlers", span=["tail", "head"], spacing="1.2 m", idler_mass="18 kg")
    >>> line.rotating_mass  # kg/m
    15.0
    """

    constants = IDLERS
    resistance_at = idler_resistance
    needs_weight = True

    kind: Literal["idlers"] = Field(description="the kind of support")
    spacing: Length = Field(gt=0, description="the distance from idler to idler, in m")
    idler_mass: Mass = Field(0.0, ge=0, description="the mass of the rotating parts of an idler, in kg")
    friction: Ratio = Field(
        0.02, ge=0, description="the hypothetical friction coefficient f of DIN 22101, for belt, goods and idlers"
    )
    secondary_factor: Ratio = Field(
        1.0, ge=1, description="the coefficient C of DIN 22101 for secondary resistances, a factor on friction"
    )
    resistance: Stiffness = Field(0.0, ge=0, description="a further resistance, independent of weight, in N/m")
    linear: LineDamping = Field(0.0, ge=0, description="the resistance in proportion to speed, in N*s/m^2")
    creep_speed: Speed = Field(0.01, gt=0, description="the speed at which resistance reaches 76 %, in m/s")

    def values(self, weight: float) -> Mapping[str, Any]:
        """As in the base."""
        friction = self.secondary_factor * self.friction
        return {
            "friction": friction,
            "constant": friction * self.rotating_mass * weight + self.resistance,
            "linear": self.linear,
            "creep_speed": self.creep_speed,
        }

    @property
    def free_length(self) -> float:
        """As in the base."""
        return self.spacing

    @property
    def rotating_mass(self) -> float:
        """As in the base."""
        return self.idler_mass / self.spacing

"""Supports that carry a span between its pulleys, their contract and resistance, and the goods on a span."""

from collections.abc import Callable, Mapping
from math import tanh
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from pydantic import ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo

from beltdyn.arrays import record
from beltdyn.kernel import KernelKinds, kernel
from beltdyn.kinds import register
from beltdyn.machines.profiles import Schedule
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Coordinate,
    Length,
    LineDamping,
    LineStiffness,
    Mass,
    MassFlowRate,
    MassPerLength,
    Name,
    Ratio,
    Speed,
    Stiffness,
)


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

    `limit`: N/m; `friction`: derivative of the limit by the normal force; `speed`, `creep_speed`: m/s.
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
        description="the normal stiffness, in N/m^2; by default belt and goods sink in by at most a millimeter",
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


IDLERS = record(
    friction="f8",  # C f
    constant="f8",  # C f m_R g + r, N/m
    linear="f8",  # l, N s/m^2
    creep_speed="f8",  # m/s
)


@kernel
def idler_resistance(constants: np.record, normal: float, speed: float) -> LineForce:
    """Kernel of `Support.resistance_at` for a row of `IDLERS`."""
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
    idler_diameter: Length | None = Field(
        None, gt=0, description="the diameter of an idler, for its speed on the sheet, in m"
    )
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


GUIDE = record(
    friction="f8",  # mu
    pressing="f8",  # p, N/m
    creep_speed="f8",  # m/s
)


@kernel
def guide_resistance(constants: np.record, normal: float, speed: float) -> LineForce:
    """Kernel of `Support.resistance_at` for a row of `GUIDE`: dry friction."""
    limit = constants.friction * (normal + constants.pressing)
    return dry_resistance(limit, constants.friction, speed, constants.creep_speed)


@register
class Guide(Support):
    """A guide or slider bed along a span, which holds the belt on both sides.

    Examples
    --------
    >>> bd.model.Guide(kind="guide", span=["newel", "drive"], friction=0.2, pressing="15 N/m").pressing
    15.0
    """

    constants = GUIDE
    resistance_at = guide_resistance

    kind: Literal["guide"] = Field(description="the kind of support")
    friction: Ratio = Field(ge=0, description="the coefficient of friction between belt and guide")
    pressing: Stiffness = Field(
        0.0, ge=0, description="the normal force of clamping, besides that of weight and curvature, in N/m"
    )
    creep_speed: Speed = Field(0.01, gt=0, description="the speed at which friction reaches 76 %, in m/s")


class MassFlow(Part):
    """Goods as a flow on a belt of a speed."""

    mass_flow: MassFlowRate = Field(
        gt=0, description='the flow of the goods at `speed`, such as "1500 t/h", instead of mass_per_length, in kg/s'
    )
    speed: Speed = Field(gt=0, description="the belt speed at which the goods flow with mass_flow, in m/s")


def _describe_flow(schema: dict[str, Any]) -> None:
    """Add the flow, which becomes a mass per length on reading, to the JSON schema."""
    schema["properties"] |= MassFlow.model_json_schema()["properties"]
    schema["required"] = [key for key in schema["required"] if key != "mass_per_length"]


class Goods(OnSpan):
    """Goods that ride on a span: they get on with the belt's speed, have weight, and are accelerated with it.

    They lie from `start` to `end`, or, as a batch, move with the belt from `start`, where they get on, to `end`. Their
    mass per length is `mass_per_length`, or `mass_flow` over `speed`.

    Examples
    --------
    >>> bd.model.Goods(span=["tail", "head"], mass_per_length="110 kg/m").mass_per_length
    110.0
    """

    model_config = ConfigDict(json_schema_extra=lambda schema: _describe_flow(schema))

    mass_per_length: MassPerLength = Field(gt=0, description="the mass of the goods over the length, in kg/m")
    schedule: Schedule | None = Field(None, description="the factor on the mass over time, from 0 to 1")
    batch: tuple[Coordinate, Coordinate] | None = Field(
        None,
        description="the rear and the front, at time zero, of a batch that moves with the belt, from the start of the "
        "span, in m; by default goods lie everywhere",
    )

    @classmethod
    def alternatives(cls) -> Mapping[str, FieldInfo]:
        """A flow with its speed replaces the mass per length."""
        return MassFlow.model_fields

    @model_validator(mode="before")
    @classmethod
    def _take_a_flow(cls, data: Any) -> Any:
        keys = MassFlow.model_fields.keys()
        if not isinstance(data, Mapping) or not any(data.get(key) is not None for key in keys):
            return data
        if data.get("mass_per_length") is not None:
            raise ValueError("mass_per_length and mass_flow exclude each other. Keep one of them")
        for key in keys:
            if data.get(key) is None:
                raise ValueError(f"{key} is missing: mass_flow and speed give the mass per length together. Give both")
        flow = MassFlow.model_validate({key: data[key] for key in keys})
        rest = {key: value for key, value in data.items() if key not in keys}
        return rest | {"mass_per_length": flow.mass_flow / flow.speed}

    @model_validator(mode="after")
    def _has_a_front(self) -> Self:
        if self.batch is not None and not self.batch[0] < self.batch[1]:
            raise ValueError(
                f"batch = [{self.batch[0]:g}, {self.batch[1]:g}] m must be the rear and the front of the batch, in the "
                "running order of the belt. Exchange them"
            )
        return self

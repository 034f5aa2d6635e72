"""A tensioner on an arm about a pivot: center p + a (cos phi u + sin phi n), phi = sense q, n the left normal of u."""

from collections.abc import Mapping
from math import cos, sin
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE, SPRING, Center, SpringTensioner
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Angle,
    AngularSpeed,
    Coordinate,
    Inertia,
    Length,
    Mass,
    Ratio,
    Torque,
    TorsionalDamping,
    TorsionalStiffness,
)

ArmAngle = Annotated[Angle, Field(ge=-np.pi, le=np.pi)]

Sense = Literal["counter-clockwise", "clockwise"]


class ArmAsSupplied(Part):
    """The arm of a tensioner by its angles, counter-clockwise from the x axis."""

    arm_length: Length | None = Field(
        None, gt=0, description="the length of the arm, instead of the center of its pulley, in m"
    )
    arm_angle: Angle | None = Field(
        None, description="the angle of the arm at its nominal position, counter-clockwise from the x axis, in rad"
    )
    free_angle: Angle | None = Field(
        None,
        description="the angle of the free arm, whose spring has no torque: with `rate` it gives `preload`; without "
        "`arm_angle` and center, and with `preload` and `sense`, the nominal position, in rad",
    )
    load_stop_angle: Angle | None = Field(
        None,
        description="the angle of the arm at its load stop: it gives `stops`, the other one at the free arm, in rad",
    )


def _describe_arm(schema: dict[str, Any]) -> None:
    """Add the angles, which are replaced by center, preload and stops on reading, to the JSON schema."""
    schema["properties"] |= ArmAsSupplied.model_json_schema()["properties"]
    schema["required"].remove("preload")
    schema["anyOf"] = [{"required": ["preload"]}, {"required": ["free_angle"]}]


ARM = record(
    pivot="2f8",  # p, m
    direction="2f8",  # u, unit vector from the pivot to the nominal center of the pulley
    length="f8",  # a, m
    sense="f8",  # +1 where turning the arm counter-clockwise lengthens the path, -1 where it shortens it
    spring=SPRING,
)


@kernel
def rotary_center(constants: np.record, q: float) -> Center:
    """Center of the pulley on the arm; constants are a row of `ARM`, q in rad."""
    x, y = constants.pivot
    ux, uy = constants.direction
    sense = constants.sense
    cosine, sine = constants.length * cos(q), constants.length * sense * sin(q)
    ax, ay = cosine * ux - sine * uy, cosine * uy + sine * ux
    return Center(x + ax, y + ay, -sense * ay, sense * ax, -ax, -ay)


@register
class RotaryTensioner(SpringTensioner):
    """A pulley on an arm, pressed against the belt by a torsional spring at the pivot.

    Examples
    --------
    >>> bd.model.RotaryTensioner(kind="rotary", pulley="idler", pivot=["100 mm", "50 mm"], preload="20 N m").pivot
    (0.1, 0.05)
    """

    model_config = ConfigDict(json_schema_extra=lambda schema: _describe_arm(schema))
    in_place_of = MappingProxyType({"free_angle": "preload", "load_stop_angle": "stops"})
    turns: ClassVar[bool] = True
    constants = ARM
    center_at = rotary_center

    kind: Literal["rotary"] = Field(description="the kind of tensioner")
    pivot: tuple[Coordinate, Coordinate] = Field(description="the pivot of the arm as [x, y], in m")
    inertia: Inertia = Field(
        0.0, ge=0, description="the moment of inertia of the arm about the pivot, without the pulley, in kg*m^2"
    )
    mass: Mass = Field(0.0, ge=0, description="the mass of the arm, without the pulley, for its weight, in kg")
    center_of_mass: Ratio = Field(
        0.5, description="the position of the arm's center of mass, from 0 at the pivot to 1 at the pulley's center"
    )
    preload: Torque = Field(description="the spring moment at the given pulley center, in N*m")
    rate: TorsionalStiffness = Field(0.0, ge=0, description="the spring rate, in N*m/rad")
    sense: Sense | None = Field(
        None, description="the sense in which the spring turns the arm; by default that in which the path lengthens"
    )
    damping: TorsionalDamping = Field(0.0, ge=0, description="the viscous damping, in N m s/rad")
    tensioning_friction: Torque = Field(0.0, ge=0, description="the dry friction while the path lengthens, in N*m")
    yielding_friction: Torque = Field(0.0, ge=0, description="the dry friction while the path shortens, in N*m")
    creep_speed: AngularSpeed = Field(0.01, gt=0, description="the speed at which dry friction reaches 76 %, in rad/s")
    stops: tuple[ArmAngle, ArmAngle] | None = Field(
        None, description="the lower and upper stops, zero at the given center, positive as the path lengthens, in rad"
    )
    stop_stiffness: TorsionalStiffness | None = Field(None, gt=0, description="the stiffness of the stops, in N*m/rad")
    stop_damping: TorsionalDamping = Field(0.0, ge=0, description="the damping of the stops, in N m s/rad")

    @classmethod
    def alternatives(cls) -> Mapping[str, FieldInfo]:
        """The angles replace center, preload and stops."""
        return ArmAsSupplied.model_fields

    @model_validator(mode="before")
    @classmethod
    def _knows_its_pulley(cls, data: Any) -> Any:
        arm = {key: data[key] for key in ArmAsSupplied.model_fields if key in data} if isinstance(data, Mapping) else {}
        if not arm:
            return data
        ArmAsSupplied.model_validate(arm)
        raise ValueError(
            f"{next(iter(arm))} depends on the pulley, which this tensioner does not know. Give preload, stops and the "
            "center of the pulley, or the keys of the tensioner as a mapping to Drive"
        )

    @property
    def anchor(self) -> tuple[float, float]:
        """Pivot of the arm, m."""
        return self.pivot

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, along the arc of the center, counter-clockwise."""
        arm = center - np.array(self.pivot)
        length = self.reach(center)
        if length == 0:
            raise ValueError(
                f'the pivot of the tensioner of "{self.pulley}" is the center of the pulley. Move one of them'
            )
        found = float(gradient @ np.array([-arm[1], arm[0]])) / length
        if abs(found) < LEAST_LEVERAGE:
            raise ValueError(
                f'the arm of the tensioner of "{self.pulley}" cannot tension the belt: its rotation hardly changes the '
                "length of the path. Move its pivot"
            )
        if self.sense is not None and (found > 0.0) != (self.sense == "counter-clockwise"):
            other = "clockwise" if found < 0.0 else "counter-clockwise"
            raise ValueError(
                f'sense = "{self.sense}" of the tensioner of "{self.pulley}": its spring would slacken the belt, '
                f"whose path lengthens by {abs(found) * self.reach(center):.3g} m per rad as the arm turns {other}. "
                "Correct the sense, or the side of the belt that touches the pulley"
            )
        return found

    def values(self, center: FloatArray, gradient: FloatArray) -> Mapping[str, Any]:
        """As in the base."""
        pivot, length = np.array(self.pivot), self.reach(center)
        sense = np.sign(self.leverage(center, gradient))
        direction = (center - pivot) / length
        return {"pivot": pivot, "direction": direction, "length": length, "sense": sense, "spring": self.spring}

    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """As in the base, kg m^2."""
        return self.inertia + mass * self.reach(center) ** 2

    def weighing_mass(self, mass: float) -> float:
        """As in the base: an arm with its center of mass at the part c of its length weighs as c times its mass."""
        return mass + self.mass * self.center_of_mass

    def reach(self, center: FloatArray) -> float:
        """Length of the arm, m."""
        return float(np.linalg.norm(center - np.array(self.pivot)))

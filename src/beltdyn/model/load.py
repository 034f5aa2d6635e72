"""Loads and motors on the shaft of a pulley: torques over its speed and angle, switched over time."""

from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.model.part import Part
from beltdyn.model.profile import Harmonic, Schedule
from beltdyn.model.quantity import AngularSpeed, QuadraticDamping, Ratio, Torque, TorsionalDamping
from beltdyn.model.table_file import check_points, describe_file, take_file


class Load(Part):
    """A torque on the shaft, counter-clockwise positive, times its schedule and 1 + the sum of its harmonics."""

    schedule: Schedule | None = Field(None, description="the factor on the torque over time, from 0 to 1")
    harmonics: tuple[Harmonic, ...] = Field((), description="the harmonics of the torque over the angle of the shaft")


class Resistance(Load):
    """A torque that opposes the motion of the shaft: constant (as dry friction), linear, quadratic in the speed."""

    kind: Literal["resistance"] = Field(description="the kind of load")
    constant: Torque = Field(0.0, ge=0, description="the part that does not depend on the speed, in N*m")
    creep_speed: AngularSpeed = Field(
        0.1, gt=0, description="the speed at which the constant part has reached 76 %, in rad/s"
    )
    linear: TorsionalDamping = Field(0.0, ge=0, description="the part linear in the speed, in N m s/rad")
    quadratic: QuadraticDamping = Field(0.0, ge=0, description="the part quadratic in the speed, in N m s^2/rad^2")

    @model_validator(mode="after")
    def _resists(self) -> Self:
        if self.constant == self.linear == self.quadratic == 0:
            raise ValueError("has no resistance. Give constant, linear or quadratic")
        return self


class LoadTable(Load):
    """A torque over the speed: linear between points, constant before the first and after the last.

    Both are counter-clockwise positive. The points are `speeds` and `torques`, or the two columns of the CSV file
    `file`, which is read when the table is made: a relative path starts at the folder of the drive file.
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, "speeds", "torques", "speed in rad/s and torque in N*m")
    )

    kind: Literal["table"] = Field(description="the kind of load")
    speeds: tuple[AngularSpeed, ...] = Field(min_length=2, description="the speeds of the points, in rad/s")
    torques: tuple[Torque, ...] = Field(min_length=2, description="the torques at these speeds, in N*m")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "speeds", "torques")

    @model_validator(mode="after")
    def _is_a_function_of_speed(self) -> Self:
        check_points("speeds", self.speeds, "torques", self.torques)
        return self


class Motor(Load):
    """An induction motor after Kloss: it drives below its synchronous speed, and brakes above it."""

    kind: Literal["motor"] = Field(description="the kind of load")
    breakdown_torque: Torque = Field(gt=0, description="the largest torque, in N*m")
    breakdown_slip: Ratio = Field(gt=0, le=1, description="the slip at which the torque is largest, 0 to 1")
    synchronous_speed: AngularSpeed = Field(
        description="the speed without load, in rad/s, negative for a motor that turns clockwise"
    )

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if self.synchronous_speed == 0:
            raise ValueError("synchronous_speed = 0 leaves the slip undefined. Give another speed")
        return self


AnyLoad = Annotated[Resistance | LoadTable | Motor, Field(discriminator="kind")]

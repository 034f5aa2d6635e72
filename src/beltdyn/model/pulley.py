"""A pulley: driven with a prescribed speed, or turning freely."""

from typing import Annotated, Self

from pydantic import Field, StringConstraints, model_validator

from beltdyn.model.part import Part
from beltdyn.model.profile import SpeedProfile, TorqueProfile
from beltdyn.model.quantity import Coordinate, Inertia, Length

Name = Annotated[str, StringConstraints(max_length=60, pattern=r"^\w[\w .-]*$")]


class Pulley(Part):
    """A round pulley whose center stays where it is.

    With `speed` its motion is prescribed; without, it turns freely with its `inertia` under the belt and
    `torque`. Speeds and torques are positive counter-clockwise, and `torque` is what is applied to the pulley:
    a load that opposes a counter-clockwise motion is negative.
    """

    name: Name = Field(description="the name of the pulley, as text")
    center: tuple[Coordinate, Coordinate] = Field(description="the center of the pulley as [x, y], in m")
    radius: Length = Field(gt=0, description="the radius at which the belt's centerline runs, in m")
    speed: SpeedProfile | None = Field(None, description="the prescribed speed over time, in rad/s")
    inertia: Inertia = Field(0.0, ge=0, description="the moment of inertia about the shaft, in kg*m^2")
    torque: TorqueProfile | None = Field(None, description="the torque applied to the pulley over time, in N*m")

    @model_validator(mode="after")
    def _is_prescribed_or_free(self) -> Self:
        if self.speed is not None and self.torque is not None:
            raise ValueError(
                "speed and torque exclude each other: a pulley of prescribed speed takes whatever torque it needs. "
                "Remove one of them"
            )
        if self.speed is None and self.inertia == 0:
            raise ValueError(
                "has neither speed nor inertia. Give speed if its motion is prescribed, "
                "or an inertia above zero if it turns freely"
            )
        return self

    @property
    def prescribed(self) -> bool:
        """Whether the motion is prescribed."""
        return self.speed is not None

"""The duty of a drive: operating points with their shares of time."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Self

from pydantic import Field, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import AngularSpeed, Name, Power, Ratio, Temperature, Time, Title

PASS = 3600.0
"""Duration of a pass of a duty given by shares of time, s."""


class DutyPoint(Part):
    """An operating point of the duty of a drive.

    What it leaves open is that of the drive file.

    Examples
    --------
    >>> bd.model.DutyPoint(share="25 %", speed="800 rpm", power={"alternator": "1.2 kW"}).power
    {'alternator': 1200.0}
    """

    name: Title | None = Field(None, description="the name of the operating point, such as idle")
    share: Ratio | None = Field(None, ge=0, le=1, description="the share of time, such as 25 %")
    duration: Time | None = Field(None, ge=0, description="the duration, instead of the share, in s")
    speed: AngularSpeed | None = Field(
        None, gt=0, description="the speed of the driver, in its sense of rotation, in rad/s"
    )
    power: dict[Name, Annotated[Power, Field(ge=0)]] = Field(
        default_factory=dict,
        description='the power that pulleys take, { alternator = "1.2 kW" }, in W; in place of their torque and loads',
    )
    load: Ratio | None = Field(
        None, ge=0, description="the factor on all torques and loads of the drive file but those of motors"
    )
    temperature: Temperature | None = Field(None, description="the temperature of the belt, in °C")

    @model_validator(mode="after")
    def _has_a_weight(self) -> Self:
        if (self.share is None) == (self.duration is None):
            raise ValueError("needs either share or duration. Give one of them")
        return self

    @property
    def weight(self) -> float:
        """Duration in a pass of the duty, s."""
        if self.duration is not None:
            return self.duration
        assert self.share is not None
        return self.share * PASS


def check_duty(duty: Sequence[DutyPoint], pulleys: Sequence[str]) -> None:
    """Check that operating points have the same measure of time, and name pulleys of the drive."""
    for number, point in enumerate(duty, 1):
        unknown = [name for name in point.power if name not in pulleys]
        if unknown:
            raise ValueError(
                f'duty[{number}].power names "{unknown[0]}", which is not a pulley. Choose from {", ".join(pulleys)}'
            )
    if len({point.share is None for point in duty}) > 1:
        raise ValueError("duty has points with share and points with duration. Give all of them the same")
    if duty and not sum(point.weight for point in duty) > 0.0:
        raise ValueError("duty has no time: all shares or durations are zero. Give some of them")


def columns_of(duty: Sequence[DutyPoint]) -> Mapping[tuple[str, str], list[float | None]]:
    """What the points of a duty give: quantity and pulley (empty of others) -> values, None where one is open."""
    powers = dict.fromkeys(name for point in duty for name in point.power)
    given: dict[tuple[str, str], list[float | None]] = {("duration", ""): [point.weight for point in duty]}
    open_: dict[tuple[str, str], list[float | None]] = {
        (key, ""): [getattr(point, key) for point in duty] for key in ("load", "temperature", "speed")
    }
    open_ |= {("power", name): [point.power.get(name) for point in duty] for name in powers}
    return given | {key: values for key, values in open_.items() if any(one is not None for one in values)}

"""A web line: an open path through which a web runs from an unwinder to a winder."""

from collections.abc import Sequence
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.machines.profiles import TorqueProfile
from beltdyn.model.end import FixedEnd
from beltdyn.model.pulley import Pulley
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Force, Inertia, Length, Name


class Roll(Part):
    """The roll of an unwinder or a winder at the beginning of a run.

    Its radius R follows from the length l that is wound, R^2 = R_c^2 + h l / pi, with the thickness h of the web and
    the radius R_c of the core.

    Examples
    --------
    >>> roll = bd.model.Roll(core_radius="50 mm", radius="300 mm")
    >>> round(roll.length_of(50e-6))
    5498
    """

    core_radius: Length = Field(gt=0, description="the radius of the core, in m")
    radius: Length | None = Field(None, gt=0, description="the radius of the roll at the beginning, in m; or length")
    length: Length | None = Field(
        None, ge=0, description="the unstretched length of web on the roll at the beginning, in m"
    )
    core_inertia: Inertia = Field(0.0, ge=0, description="the moment of inertia of core and shaft, in kg m^2")

    @model_validator(mode="after")
    def _has_one_size(self) -> Self:
        if (self.radius is None) == (self.length is None):
            raise ValueError("needs one of radius and length, which follow from each other. Give one of the two")
        if self.radius is not None and self.radius < self.core_radius:
            raise ValueError(
                f"radius = {self.radius:g} m is below core_radius = {self.core_radius:g} m. Give the outer radius of "
                "the roll"
            )
        return self

    def length_of(self, thickness: float) -> float:
        """Unstretched length of web at the beginning, m, of a web of a thickness (m)."""
        if self.length is not None:
            return self.length
        return float(np.pi * ((self.radius or 0.0) ** 2 - self.core_radius**2) / thickness)

    def radius_at(self, length: FloatArray, thickness: float) -> FloatArray:
        """Radius, m, with unstretched lengths (m, any shape) of a web of a thickness (m)."""
        return np.asarray(np.sqrt(self.core_radius**2 + thickness * np.maximum(length, 0.0) / np.pi))

    def inertia_at(self, length: FloatArray, thickness: float, mass_per_length: float) -> FloatArray:
        """Moment of inertia, kg m^2, of core and web; mass in kg/m, other arguments as for `radius_at`."""
        square = self.radius_at(length, thickness) ** 2 + self.core_radius**2
        return np.asarray(self.core_inertia + 0.5 * mass_per_length * np.maximum(length, 0.0) * square)


class WebEnd(Part):
    """Where the web of a line leaves its unwinder, or reaches its winder, by a controlled tension or a torque."""

    name: Name
    point: tuple[Coordinate, Coordinate]
    tension: Force | None
    torque: TorqueProfile | None
    roll: Roll | None

    @model_validator(mode="after")
    def _pulls_the_web(self) -> Self:
        if (self.tension is None) == (self.torque is None):
            raise ValueError("needs one of tension, which a drive keeps, and torque, on the roll. Give one of the two")
        if self.torque is None:
            return self
        if self.roll is None:
            raise ValueError("torque acts on a roll, which is missing. Give the group roll, or tension instead")
        starts = np.maximum(self.torque.segments().start, 0.0)  # within a piece all kinds are monotonic
        least = float(np.min(self.torque.around(starts)))
        if least <= 0.0:
            raise ValueError(
                f"torque = {least:g} N m must be positive: it tightens the web, at the unwinder and at the winder. "
                "Correct it"
            )
        return self

    @property
    def end(self) -> FixedEnd:
        """The end of the path."""
        return FixedEnd(name=self.name, kind="fixed", point=self.point)

    def tension_at(self, time: float, thickness: float) -> float:
        """Tension of a web of a thickness (m) in steady running, N: as kept, or M/R of the roll as it begins."""
        if self.torque is None or self.roll is None:
            return float(self.tension or 0.0)
        length = np.array([self.roll.length_of(thickness)])
        return float(self.torque.at(np.array([time]))[0] / self.roll.radius_at(length, thickness)[0])


class Unwinder(WebEnd):
    """The unwinder of a web line: a drive that keeps the tension of the web, or a roll with a brake.

    Examples
    --------
    >>> bd.model.Unwinder(point=[0, "0.4 m"], tension="120 N").tension
    120.0
    """

    name: Name = Field("unwinder", description="the name of the unwinder, used in the names of spans")
    point: tuple[Coordinate, Coordinate] = Field(
        description="the point at which the web leaves the unwinder, as [x, y], in m"
    )
    tension: Force | None = Field(
        None, gt=0, description="the tension of the web that enters the line, which a drive keeps, in N; or torque"
    )
    torque: TorqueProfile | None = Field(
        None, description="the torque of the brake, over time, in N m; inertia of the roll then acts on the web"
    )
    roll: Roll | None = Field(None, description="the roll, a group [unwinder.roll]; by default none")


class Winder(WebEnd):
    """The winder of a web line: a drive that keeps the tension of the web, or a roll with a torque.

    Examples
    --------
    >>> bd.model.Winder(point=["3 m", "0.4 m"], tension="150 N").name
    'winder'
    """

    name: Name = Field("winder", description="the name of the winder, used in the names of spans")
    point: tuple[Coordinate, Coordinate] = Field(
        description="the point at which the web reaches the winder, as [x, y], in m"
    )
    tension: Force | None = Field(
        None, gt=0, description="the tension of the web that is wound up, which a drive keeps, in N; or torque"
    )
    torque: TorqueProfile | None = Field(
        None, description="the torque of the drive, over time, in N m; inertia of the roll then acts on the web"
    )
    roll: Roll | None = Field(None, description="the roll, a group [winder.roll]; by default none")


def check_rollers(pulleys: Sequence[Pulley]) -> None:
    """Refuse a web line that nothing moves, or that runs from the winder to the unwinder."""
    driven = [one for one in pulleys if one.prescribed or any(load.driven_speed for load in one.load)]
    if not driven:
        raise ValueError(
            "nothing moves the web: no roller has a speed or a motor, and [unwinder] and [winder] only keep tensions. "
            "Give one [[pulley]] its speed"
        )
    for roller in driven:
        if roller.speed is not None and roller.turning * float(np.min(roller.speed.at(np.zeros(1)))) < 0.0:
            raise ValueError(
                f'the speed of "{roller.name}" moves the web from the winder to the unwinder. Reverse its sign, or '
                "list unwinder, rollers and winder in running order"
            )

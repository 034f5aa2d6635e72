"""Tensioners: what presses a pulley against the belt."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.model.part import Part
from beltdyn.model.path import Path
from beltdyn.model.pulley import Name, Pulley
from beltdyn.model.quantity import (
    Angle,
    AngularSpeed,
    Coordinate,
    Damping,
    Force,
    Inertia,
    Mass,
    Ratio,
    Speed,
    Stiffness,
    Torque,
    TorsionalDamping,
    TorsionalStiffness,
)

_ROUNDING = 4 * np.finfo(float).eps
LEAST_LEVERAGE = 1e-3
"""Smallest part of a unit motion of the pulley's center that must lengthen the path."""


def _unit(vector: tuple[float, float]) -> tuple[float, float]:
    """Make a vector one metre long; one that is so already stays as it is."""
    length = float(np.hypot(*vector))
    if length == 0:
        raise ValueError("points nowhere: at least one component must differ from zero")
    if abs(length - 1) <= _ROUNDING:
        return vector
    return vector[0] / length, vector[1] / length


Direction = Annotated[tuple[Ratio, Ratio], AfterValidator(_unit)]
ArmAngle = Annotated[Angle, Field(ge=-np.pi, le=np.pi)]


class _Carrier(Part):
    """What holds a pulley other than at a fixed place."""

    pulley: Name = Field(description="the name of the pulley that it carries")


class FixedTensioner(_Carrier):
    """A pulley that is moved along a line before the drive runs, and held there."""

    kind: Literal["fixed"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction in which the take-up moves the pulley, as [x, y]")
    take_up: Coordinate = Field(0.0, description="the distance by which the pulley is moved from its center, in m")


class MovingTensioner(_Carrier):
    """A spring presses the pulley against the belt; the coordinate q is zero at the center that the pulley is given.

    q grows where the path of the belt gets longer. The units of the numbers differ: m and N along a line, rad and
    N m about a pivot.
    """

    creep_speed: float
    stops: tuple[float, float] | None
    stop_stiffness: float | None
    stop_damping: float

    @model_validator(mode="after")
    def _stops_hold_the_nominal_place(self) -> Self:
        if self.stops is None:
            if self.stop_stiffness is not None or self.stop_damping != 0:
                raise ValueError(
                    "stops is missing: stop_stiffness and stop_damping belong to stops. Give stops = [lower, upper]"
                )
            return self
        lower, upper = self.stops
        if not lower <= 0 <= upper or lower == upper:
            raise ValueError(
                f"stops = [{lower:g}, {upper:g}] must be a lower and an upper one with zero between, the place of the "
                "pulley's center"
            )
        if self.stop_stiffness is None:
            raise ValueError("stop_stiffness is missing: stops are springs. Give stop_stiffness")
        return self

    @abstractmethod
    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """How much of the motion of the pulley's center lengthens the path, dL/ds.

        Parameters
        ----------
        center : ndarray, shape (2,), m
            Nominal center of the pulley.
        gradient : ndarray, shape (2,)
            Derivative of the length of the path with respect to the center.

        Returns
        -------
        float
            Metre of path for a metre along the line, or along the arc of the arm turned counter-clockwise.

        Raises
        ------
        ValueError
            If the tensioner cannot tension the belt.
        """

    @abstractmethod
    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """Inertia of the tensioner with its pulley, a point mass since it turns on its own: kg, or kg m^2.

        Parameters
        ----------
        center : ndarray, shape (2,), m
            Nominal center of the pulley.
        mass : float
            Mass of the pulley, kg.
        """


class SlidingTensioner(MovingTensioner):
    """A pulley that slides along a line, pressed by a spring in `direction`."""

    kind: Literal["sliding"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction in which the spring presses the pulley, as [x, y]")
    mass: Mass = Field(0.0, ge=0, description="the mass that slides with the pulley, without it, in kg")
    preload: Force = Field(description="the force of the spring at the pulley's center, in N")
    rate: Stiffness = Field(0.0, ge=0, description="the rate of the spring, in N/m")
    damping: Damping = Field(0.0, ge=0, description="the viscous damping, in N*s/m")
    tensioning_friction: Force = Field(0.0, ge=0, description="the dry friction while the path gets longer, in N")
    yielding_friction: Force = Field(0.0, ge=0, description="the dry friction while the path gets shorter, in N")
    creep_speed: Speed = Field(1e-3, gt=0, description="the speed at which dry friction has reached 76 %, in m/s")
    stops: tuple[Coordinate, Coordinate] | None = Field(
        None, description="the lower and the upper stop, from the pulley's center along the direction, in m"
    )
    stop_stiffness: Stiffness | None = Field(None, gt=0, description="the stiffness of the stops, in N/m")
    stop_damping: Damping = Field(0.0, ge=0, description="the damping of the stops, in N*s/m")

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, along `direction`."""
        found = float(gradient @ np.array(self.direction))
        if found < LEAST_LEVERAGE:
            raise ValueError(
                f'the tensioner of "{self.pulley}" cannot tension the belt: a metre along its direction lengthens the '
                f"path by {found:.3g} m. Choose a direction in which the path gets longer"
            )
        return found

    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """As in the base, kg."""
        return self.mass + mass


class RotaryTensioner(MovingTensioner):
    """A pulley on an arm, pressed against the belt by a torsional spring about the pivot of the arm."""

    kind: Literal["rotary"] = Field(description="the kind of tensioner")
    pivot: tuple[Coordinate, Coordinate] = Field(description="the pivot of the arm as [x, y], in m")
    inertia: Inertia = Field(
        0.0, ge=0, description="the moment of inertia of the arm about the pivot, without the pulley, in kg*m^2"
    )
    mass: Mass = Field(0.0, ge=0, description="the mass of the arm, without the pulley, for its weight, in kg")
    center_of_mass: Ratio = Field(
        0.5, description="the place of the arm's center of mass, from 0 at the pivot to 1 at the pulley's center"
    )
    preload: Torque = Field(description="the moment of the spring at the pulley's center, in N*m")
    rate: TorsionalStiffness = Field(0.0, ge=0, description="the rate of the spring, in N*m/rad")
    damping: TorsionalDamping = Field(0.0, ge=0, description="the viscous damping, in N m s/rad")
    tensioning_friction: Torque = Field(0.0, ge=0, description="the dry friction while the path gets longer, in N*m")
    yielding_friction: Torque = Field(0.0, ge=0, description="the dry friction while the path gets shorter, in N*m")
    creep_speed: AngularSpeed = Field(
        0.01, gt=0, description="the speed at which dry friction has reached 76 %, in rad/s"
    )
    stops: tuple[ArmAngle, ArmAngle] | None = Field(
        None, description="the lower and the upper stop, from the pulley's center the way the path gets longer, in rad"
    )
    stop_stiffness: TorsionalStiffness | None = Field(None, gt=0, description="the stiffness of the stops, in N*m/rad")
    stop_damping: TorsionalDamping = Field(0.0, ge=0, description="the damping of the stops, in N m s/rad")

    def arm_length(self, center: FloatArray) -> float:
        """Distance of the pulley's center from the pivot, m."""
        return float(np.linalg.norm(center - np.array(self.pivot)))

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, along the arc of the center, counter-clockwise."""
        arm = center - np.array(self.pivot)
        length = self.arm_length(center)
        if length == 0:
            raise ValueError(
                f'the pivot of the tensioner of "{self.pulley}" is the center of the pulley. Move one of them'
            )
        found = float(gradient @ np.array([-arm[1], arm[0]])) / length
        if abs(found) < LEAST_LEVERAGE:
            raise ValueError(
                f'the arm of the tensioner of "{self.pulley}" cannot tension the belt: turning it hardly changes the '
                "length of the path. Move its pivot"
            )
        return found

    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """As in the base, kg m^2."""
        return self.inertia + mass * self.arm_length(center) ** 2


def place_of(tensioner: MovingTensioner, position: float) -> str:
    """Write a position of a tensioner, m or rad, with its unit."""
    return f"{math.degrees(position):.4g}°" if isinstance(tensioner, RotaryTensioner) else f"{position:.4g} m"


def check_tensioners(tensioners: Sequence["AnyTensioner"], pulleys: Sequence[Pulley], path: Path) -> None:
    """Check that tensioners carry the pulleys of a drive, and can tension its belt.

    Parameters
    ----------
    tensioners : sequence
        The tensioners.
    pulleys : sequence of Pulley
        The pulleys.
    path : Path
        Around all pulleys.

    Raises
    ------
    ValueError
        If a pulley does not exist or is carried twice, or a tensioner does not tension or has no inertia.
    """
    names, carried = [pulley.name for pulley in pulleys], [item.pulley for item in tensioners]
    for position, (item, name) in enumerate(zip(tensioners, carried, strict=True), 1):
        if name not in names:
            raise ValueError(
                f'tensioner[{position}].pulley = "{name}" is not the name of a pulley. Known here: {", ".join(names)}'
            )
        if carried.count(name) > 1:
            raise ValueError(
                f'pulley "{name}" is carried by {carried.count(name)} tensioners, and one can carry it. '
                "Remove the others"
            )
        if isinstance(item, MovingTensioner):
            center, gradient = path_gradient(path, names.index(name))
            item.leverage(center, gradient)
            if item.moved_inertia(center, pulleys[names.index(name)].mass) == 0:
                raise ValueError(
                    f'the tensioner of "{name}" moves nothing that has inertia. Give the pulley\'s mass, or that of '
                    "the tensioner"
                )


def path_gradient(path: Path, pulley: int) -> tuple[FloatArray, FloatArray]:
    """Center of a pulley, and the derivative of the length of the path with respect to it.

    The derivative is u_in - u_out, the unit vectors along the spans before and behind the pulley; arcs do not
    contribute, since the path is the shortest one.

    Parameters
    ----------
    path : Path
        Around all pulleys.
    pulley : int
        Number of the pulley.

    Returns
    -------
    center : ndarray, shape (2,), m
    gradient : ndarray, shape (2,)
    """
    return path.centers[pulley], path.span_directions[pulley - 1] - path.span_directions[pulley]


AnyTensioner = FixedTensioner | SlidingTensioner | RotaryTensioner
Tensioner = Annotated[AnyTensioner, Field(discriminator="kind")]

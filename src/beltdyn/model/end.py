"""Ends of an open belt: fixed at a point, pulled by a force or a weight, or clamped to the carriage of an axis."""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles import PushProfile
from beltdyn.machines.profiles.functions import profile_integral, profile_rows
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.tensioners.tensioner import Direction
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Damping, Flag, Force, Length, Mass, Name, Speed, Stiffness


class PathEnd(NamedTuple):
    """An end as the path of the belt sees it."""

    name: str
    point: FloatArray | None
    """Its fixed point, m, shape (2,); None for a pulled end."""
    pull: FloatArray | None
    """The pulling force at rest, N, shape (2,); None for a fixed end."""


class End(Part):
    """An end of an open belt."""

    name: Name = Field(description="the name of the end, used in the names of spans")

    if TYPE_CHECKING:  # the field that tells the kinds apart
        kind: str

    @property
    def held(self) -> bool:
        """Whether the end does not move."""
        return False

    @property
    def turning_held(self) -> bool:
        """Whether the end does not turn."""
        return False

    @property
    def force(self) -> tuple[float, float]:
        """Constant force on the end, besides weight, N."""
        return 0.0, 0.0

    @property
    def attached_mass(self) -> float:
        """Mass that moves with the end, kg."""
        return 0.0

    def on_path(self, gravity: tuple[float, float]) -> PathEnd:
        """The end as the path sees it."""
        pull = np.array(self.force) + self.attached_mass * np.array(gravity)
        if not np.any(pull):
            raise ValueError(
                f'no force pulls end "{self.name}": gravity = [0, 0] gives its mass no weight. '
                "Give gravity, such as [0, -9.81]"
            )
        return PathEnd(self.name, None, pull)


class FixedEnd(End):
    """An end that is fixed at a point.

    Examples
    --------
    >>> bd.model.FixedEnd(name="anchor", kind="fixed", point=["0 mm", "200 mm"]).point
    (0.0, 0.2)
    """

    kind: Literal["fixed"] = Field(description="the kind of end")
    point: tuple[Coordinate, Coordinate] = Field(description="the point at which the belt is fixed, as [x, y], in m")
    clamped: Flag = Field(
        False, description="whether the belt is clamped: its section stays square to the straight span"
    )

    @property
    def held(self) -> bool:
        """Whether the end does not move."""
        return True

    @property
    def turning_held(self) -> bool:
        """Whether the end does not turn."""
        return self.clamped

    def on_path(self, gravity: tuple[float, float]) -> PathEnd:
        """The end as the path sees it."""
        return PathEnd(self.name, np.array(self.point), None)


class PulledEnd(End):
    """An end pulled by a constant force.

    Examples
    --------
    >>> bd.model.PulledEnd(name="lever", kind="pulled", direction=[0, -1], tension="50 N").tension
    50.0
    """

    kind: Literal["pulled"] = Field(description="the kind of end")
    direction: Direction = Field(description="the direction of the force, away from the belt, as [x, y]")
    tension: Force = Field(gt=0, description="the constant force that pulls the end, in N")

    @property
    def force(self) -> tuple[float, float]:
        """Constant force on the end, besides weight, N."""
        return self.tension * self.direction[0], self.tension * self.direction[1]


class WeightEnd(End):
    """An end loaded by a hanging weight.

    Examples
    --------
    >>> bd.model.WeightEnd(name="weight", kind="weight", mass="5 kg").mass
    5.0
    """

    kind: Literal["weight"] = Field(description="the kind of end")
    mass: Mass = Field(gt=0, description="the hanging mass, in kg")

    @property
    def attached_mass(self) -> float:
        """Mass that moves with the end, kg."""
        return self.mass


if TYPE_CHECKING:
    AnyEnd = End
else:
    AnyEnd = Annotated[FixedEnd | PulledEnd | WeightEnd, Field(discriminator="kind")]


def ends_on_path(ends: tuple[End, ...], gravity: tuple[float, float]) -> tuple[PathEnd, ...]:
    """The ends of a belt as its path sees them."""
    if len(ends) not in (0, 2):
        raise ValueError(
            f"the number of [[end]] is {len(ends)}; a closed belt has no ends, an open belt has two, in running order. "
            "Give both, or remove them"
        )
    if ends and not any(end.held for end in ends):
        raise ValueError(
            f'ends "{ends[0].name}" and "{ends[1].name}" are both pulled; at rest, without friction, there is no '
            'equilibrium. Set kind = "fixed" for one of them'
        )
    return tuple(end.on_path(gravity) for end in ends)


def pulling(ends: tuple[PathEnd, ...]) -> float | None:
    """Tension at rest by a pulled end, N; None without one."""
    return next((float(np.linalg.norm(end.pull)) for end in ends if end.pull is not None), None)


_INSTANTS = 101
"""Instants at which a way is looked at, besides those at which a move changes."""
_MOST_OBLIQUE = np.radians(5.0)
"""Largest angle between the belt at a clamp and the guide."""


class Carriage(Part):
    """A carriage on a straight guide that both ends of the belt are clamped to.

    Its coordinate is the way from `center` along `direction`. The belt runs from the clamp at the side of the first
    pulley over all pulleys to the other clamp.

    Examples
    --------
    >>> axis = bd.model.Carriage(center=["0.2 m", "6.37 mm"], direction=[1, 0], length="40 mm", mass="0.3 kg")
    >>> axis.mass, axis.name
    (0.3, 'carriage')
    """

    name: Name = Field("carriage", description="the name of the carriage, used in the names of spans")
    center: tuple[Coordinate, Coordinate] = Field(
        description="the point halfway between both clamps at the beginning, as [x, y], in m"
    )
    direction: Direction = Field(description="the direction of the guide, as [x, y]")
    length: Length = Field(0.0, ge=0, description="the distance of both clamps, in m")
    mass: Mass = Field(gt=0, description="the moved mass without the belt, in kg")
    friction: Force = Field(0.0, ge=0, description="the dry friction of the guide, in N")
    creep_speed: Speed = Field(1e-3, gt=0, description="the speed at which dry friction reaches 76 %, in m/s")
    damping: Damping = Field(0.0, ge=0, description="the viscous friction of the guide, in N*s/m")
    force: PushProfile | None = Field(
        None, description="the force on the carriage over time, positive in `direction`, in N"
    )
    stroke: tuple[Coordinate, Coordinate] | None = Field(
        None, description="the ways from the center to the stops, as [lower, upper], in m"
    )
    stop_stiffness: Stiffness | None = Field(None, gt=0, description="the stiffness of the stops, in N/m")
    stop_damping: Damping = Field(0.0, ge=0, description="the damping of the stops, in N*s/m")

    @model_validator(mode="after")
    def _begins_within_its_stroke(self) -> Self:
        if self.stroke is None:
            if self.stop_stiffness is not None or self.stop_damping:
                raise ValueError("stroke is missing, but stop_stiffness or stop_damping is given. Give stroke")
            return self
        lower, upper = self.stroke
        if not lower <= 0.0 <= upper or lower == upper:
            raise ValueError(
                f"stroke = [{lower:g}, {upper:g}] m must be a lower and an upper way on both sides of zero, where the "
                "carriage begins. Correct it, or move center"
            )
        return self

    def clamps(self, first: Sequence[float]) -> tuple[FloatArray, FloatArray]:
        """Places of the clamps at the beginning, m, that at the side of the first pulley with its center first."""
        way = 0.5 * self.length * np.array(self.direction)
        side = 1.0 if np.dot(np.subtract(first, self.center), self.direction) > 0.0 else -1.0
        return np.array(self.center) + side * way, np.array(self.center) - side * way

    def ends(self, first: Sequence[float]) -> tuple[FixedEnd, FixedEnd]:
        """Both ends of the belt at rest, in running order, by the center of the first pulley."""
        begin, end = self.clamps(first)
        return (
            FixedEnd(name=f"{self.name} out", kind="fixed", point=(begin[0], begin[1])),
            FixedEnd(name=f"{self.name} in", kind="fixed", point=(end[0], end[1])),
        )

    @property
    def spring(self) -> dict[str, float]:
        """Values of a row of `machines.tensioners.tensioner.SPRING`, whose coordinate is that of the carriage."""
        lower, upper = self.stroke or (-np.inf, np.inf)
        return {
            "damping": self.damping,
            "tensioning_friction": self.friction,
            "yielding_friction": self.friction,
            "creep_speed": self.creep_speed,
            "lower": lower,
            "upper": upper,
            "stop_stiffness": self.stop_stiffness or 0.0,
            "stop_damping": self.stop_damping,
        }


def check_carriage(
    carriage: Carriage, path: Path, pulleys: Sequence[Pulley], path_ends: tuple[PathEnd, ...], duration: float
) -> None:
    """Refuse a carriage that its belt does not move along the guide, or that would go beyond its stroke."""
    if not any(one.prescribed or one.load or one.torque is not None for one in pulleys):
        raise ValueError(
            f'nothing moves "{carriage.name}": no pulley of the axis has a speed, a motor or a torque. Give one pulley '
            "its speed, such as a profile of moves, or a load of kind servo_motor"
        )
    along = np.array(carriage.direction)
    for name, way in zip((path_ends[0].name, path_ends[1].name), path.ways_out, strict=True):
        angle = float(np.arcsin(min(1.0, abs(along[0] * way[1] - along[1] * way[0]))))
        if angle > _MOST_OBLIQUE:
            raise ValueError(
                f'the belt leaves "{name}" at {np.degrees(angle):.3g}° to the guide; it must run along it within '
                f"{np.degrees(_MOST_OBLIQUE):.0f}°. Move center onto the line of the belt, which touches the pulleys, "
                "or correct direction"
            )
    room = free_stroke(carriage, path)
    if carriage.stroke is not None and (carriage.stroke[0] < room[0] or carriage.stroke[1] > room[1]):
        raise ValueError(
            f"stroke = [{carriage.stroke[0]:.5g}, {carriage.stroke[1]:.5g}] m is longer than the belt between the "
            f'pulleys: a clamp of "{carriage.name}" would reach a pulley at {room[0]:.5g} or {room[1]:.5g} m. Shorten '
            "it, or move the pulleys apart"
        )
    _check_way(carriage, path, pulleys, duration, room)


def _check_way(
    carriage: Carriage, path: Path, pulleys: Sequence[Pulley], duration: float, room: tuple[float, float]
) -> None:
    """Refuse speeds of a driver that move the carriage beyond its stroke."""
    lower, upper = carriage.stroke or room
    for pulley, ways in _prescribed_ways(carriage, path, pulleys, duration):
        if ways.min() < lower or ways.max() > upper:
            way = float(ways.min() if ways.min() < lower else ways.max())
            what = "its stroke" if carriage.stroke else "where a clamp reaches a pulley"
            raise ValueError(
                f'the speed of "{pulley.name}" moves "{carriage.name}" to {way:.5g} m, beyond {what}, {lower:.5g} to '
                f"{upper:.5g} m. Shorten the move, reverse its sense, or move center"
            )


def _prescribed_ways(
    carriage: Carriage, path: Path, pulleys: Sequence[Pulley], duration: float
) -> Iterator[tuple[Pulley, FloatArray]]:
    """Pulleys with prescribed speed, and ways on which they move a carriage, m."""
    for number, pulley in enumerate(pulleys):
        if pulley.speed is not None:
            yield pulley, carriage_rate(carriage, path, number) * turned(pulley.speed, duration)


def range_of(carriage: Carriage, path: Path, pulleys: Sequence[Pulley], duration: float) -> tuple[float, float]:
    """Ways between which a carriage moves, m: its stroke, those of a driver with prescribed speed, or its room."""
    if carriage.stroke is not None:
        return carriage.stroke
    for _, ways in _prescribed_ways(carriage, path, pulleys, duration):
        return float(ways.min()), float(ways.max())
    return free_stroke(carriage, path)


def carriage_rate(carriage: Carriage, path: Path, pulley: int) -> float:
    """Way of the carriage in a radian of a pulley, counter-clockwise, with a belt that does not stretch, m."""
    return -float(path.radii[pulley] * np.dot(path.ways_out[0], carriage.direction))


@lru_cache(maxsize=64)
def turned(speed: Profile, duration: float) -> FloatArray:
    """Angles that a speed has turned since time zero at some instants, rad; not to be changed."""
    starts = speed.integrated.start
    times = np.union1d(np.linspace(0.0, duration, _INSTANTS), starts[(starts > 0.0) & (starts < duration)])
    rows = profile_rows([speed], [()])
    return np.array([interpreted(profile_integral)(rows, 0, time) for time in times.tolist()])


def free_stroke(carriage: Carriage, path: Path) -> tuple[float, float]:
    """Ways of the carriage until a clamp reaches a pulley, below and above zero, m, with spans along the guide."""
    first, last = float(path.span_lengths[-1]), float(path.span_lengths[-2])
    begin = np.dot(path.ways_out[0], carriage.direction)
    return (-last, first) if begin < 0.0 else (-first, last)

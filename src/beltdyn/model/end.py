"""Ends of an open belt: fixed at a point, or pulled by a force or a weight."""

from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.machines.tensioners.direction import Direction
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Flag, Force, Mass, Name


class PathEnd(NamedTuple):
    """What the path of a belt needs to know of an end."""

    name: str
    point: FloatArray | None
    """Where it is fixed, m, shape (2,); none for an end that is pulled."""
    pull: FloatArray | None
    """Force that pulls it at rest, N, shape (2,); none for an end that is fixed."""


class End(Part):
    """An end of an open belt."""

    name: Name = Field(description="the name of the end, in the names of spans")

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
        """Constant force on the end beside weight, N."""
        return 0.0, 0.0

    @property
    def attached_mass(self) -> float:
        """Mass that moves with the end, kg."""
        return 0.0

    def on_path(self, gravity: tuple[float, float]) -> PathEnd:
        """What the path needs to know of the end.

        Parameters
        ----------
        gravity : tuple of float
            Acceleration of gravity, m/s^2.

        Raises
        ------
        ValueError
            If nothing pulls the end.
        """
        pull = np.array(self.force) + self.attached_mass * np.array(gravity)
        if not np.any(pull):
            raise ValueError(
                f'nothing pulls end "{self.name}": gravity = [0, 0] leaves its mass without weight. '
                "Give gravity, such as [0, -9.81]"
            )
        return PathEnd(self.name, None, pull)


class FixedEnd(End):
    """An end that is fixed at a point.

    Examples
    --------
    >>> bd.FixedEnd(name="anchor", kind="fixed", point=["0 mm", "200 mm"]).point
    (0.0, 0.2)
    """

    kind: Literal["fixed"] = Field(description="the kind of end")
    point: tuple[Coordinate, Coordinate] = Field(description="the point at which the belt is fixed, as [x, y], in m")
    clamped: Flag = Field(
        False, description="whether the belt cannot turn there: its section stays square to the straight span"
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
        """What the path needs to know of the end."""
        return PathEnd(self.name, np.array(self.point), None)


class PulledEnd(End):
    """An end that a constant force pulls.

    Examples
    --------
    >>> bd.PulledEnd(name="lever", kind="pulled", direction=[0, -1], tension="50 N").tension
    50.0
    """

    kind: Literal["pulled"] = Field(description="the kind of end")
    direction: Direction = Field(description="the direction of the force, away from the belt, as [x, y]")
    tension: Force = Field(gt=0, description="the constant force that pulls the end, in N")

    @property
    def force(self) -> tuple[float, float]:
        """Constant force on the end beside weight, N."""
        return self.tension * self.direction[0], self.tension * self.direction[1]


class WeightEnd(End):
    """An end at which a weight hangs.

    Examples
    --------
    >>> bd.WeightEnd(name="weight", kind="weight", mass="5 kg").mass
    5.0
    """

    kind: Literal["weight"] = Field(description="the kind of end")
    mass: Mass = Field(gt=0, description="the mass that hangs at the end, which gravity pulls, in kg")

    @property
    def attached_mass(self) -> float:
        """Mass that moves with the end, kg."""
        return self.mass


if TYPE_CHECKING:
    AnyEnd = End
else:
    AnyEnd = Annotated[FixedEnd | PulledEnd | WeightEnd, Field(discriminator="kind")]


def ends_on_path(ends: tuple[End, ...], gravity: tuple[float, float]) -> tuple[PathEnd, ...]:
    """What the path of a belt needs to know of its ends.

    Parameters
    ----------
    ends : tuple of End
        None for a closed belt; the first and the second end of an open one.
    gravity : tuple of float
        Acceleration of gravity, m/s^2.

    Raises
    ------
    ValueError
        If the number of ends is not zero or two, none of two is fixed, or nothing pulls one that is not.
    """
    if len(ends) not in (0, 2):
        raise ValueError(
            f"the number of [[end]] is {len(ends)}: a closed belt has none, and an open belt has two, in the order in "
            "which it runs. Give both, or none"
        )
    if ends and not any(end.held for end in ends):
        raise ValueError(
            f'ends "{ends[0].name}" and "{ends[1].name}" are both pulled: at rest, without friction, one would pull '
            'the belt away from the other. Give one of them kind = "fixed"'
        )
    return tuple(end.on_path(gravity) for end in ends)


def pulling(ends: tuple[PathEnd, ...]) -> float | None:
    """Tension that a pulled end gives the belt at rest, N; None without such an end."""
    return next((float(np.linalg.norm(end.pull)) for end in ends if end.pull is not None), None)

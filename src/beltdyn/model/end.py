"""Ends of an open belt: fixed at a point, or pulled by a force or a weight."""

from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.machines.tensioners.tensioner import Direction
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Flag, Force, Mass, Name


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

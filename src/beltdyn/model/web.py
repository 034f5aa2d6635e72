"""A web line: an open path through which a web runs from an unwinder to a winder."""

from collections.abc import Sequence

import numpy as np
from pydantic import Field

from beltdyn.model.end import FixedEnd
from beltdyn.model.pulley import Pulley
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Force, Name


class WebEnd(Part):
    """Where the web of a line leaves its unwinder, or reaches its winder, with a controlled tension."""

    name: Name
    point: tuple[Coordinate, Coordinate]
    tension: Force

    @property
    def end(self) -> FixedEnd:
        """The end of the path."""
        return FixedEnd(name=self.name, kind="fixed", point=self.point)


class Unwinder(WebEnd):
    """The unwinder of a web line, which keeps the tension of the web that it gives off.

    Examples
    --------
    >>> bd.model.Unwinder(point=[0, "0.4 m"], tension="120 N").tension
    120.0
    """

    name: Name = Field("unwinder", description="the name of the unwinder, used in the names of spans")
    point: tuple[Coordinate, Coordinate] = Field(
        description="the point at which the web leaves the unwinder, as [x, y], in m"
    )
    tension: Force = Field(gt=0, description="the tension of the web that enters the line, in N")


class Winder(WebEnd):
    """The winder of a web line, which keeps the tension of the web that it takes up.

    Examples
    --------
    >>> bd.model.Winder(point=["3 m", "0.4 m"], tension="150 N").name
    'winder'
    """

    name: Name = Field("winder", description="the name of the winder, used in the names of spans")
    point: tuple[Coordinate, Coordinate] = Field(
        description="the point at which the web reaches the winder, as [x, y], in m"
    )
    tension: Force = Field(gt=0, description="the tension of the web that is wound up, in N")


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

"""A tensioner set before the drive runs."""

from typing import Literal

from pydantic import Field

from beltdyn.machines.tensioners.direction import Direction
from beltdyn.machines.tensioners.tensioner import Tensioner
from beltdyn.parts.quantity import Coordinate


class FixedTensioner(Tensioner):
    """A pulley moved along a line before the drive runs, and held there.

    Examples
    --------
    >>> bd.FixedTensioner(kind="fixed", pulley="idler", direction=[0, 2], take_up="10 mm").take_up
    0.01
    """

    kind: Literal["fixed"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction of the take-up, as [x, y]")
    take_up: Coordinate = Field(0.0, description="the displacement of the pulley from its center, in m")

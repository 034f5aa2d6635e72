"""The drive: a belt, its pulleys, their contact, and how to simulate them."""

from collections.abc import Callable
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr, model_validator

from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.layout import lay_path
from beltdyn.model.part import Part
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, friction_on
from beltdyn.model.quantity import Acceleration
from beltdyn.model.simulation import Simulation
from beltdyn.model.tensioner import AnyTensioner, Tensioner, check_tensioners
from beltdyn.model.toml_writer import dumps

FloatArray = NDArray[np.float64]

_LARGEST_STRAIN = 0.5


class Drive(Part):
    """A belt drive, complete and consistent.

    The constructor's arguments are `belt`, `pulley` (a list of pulleys, counter-clockwise), `contact`, `tensioner`
    (a list) and `simulation`, each a part or a mapping of its arguments, and `gravity`.
    """

    belt: Belt = Field(description="the group [belt]")
    pulleys: tuple[Pulley, ...] = Field(alias="pulley", description="the groups [[pulley]], counter-clockwise")
    contact: Contact = Field(description="the group [contact]")
    tensioners: tuple[Tensioner, ...] = Field((), alias="tensioner", description="the groups [[tensioner]]")
    simulation: Simulation = Field(description="the group [simulation]")
    gravity: tuple[Acceleration, Acceleration] = Field(
        (0.0, 0.0), description="the acceleration of gravity as [x, y], in m/s^2"
    )
    _source: str | None = PrivateAttr(None)

    def __reduce__(self) -> tuple[Callable[[str], "Drive"], tuple[str]]:
        """Travel between processes as a drive file."""
        from beltdyn.model.toml_reader import loads

        return loads, (self.text,)

    @model_validator(mode="after")
    def _belt_fits_its_path(self) -> Self:
        length, path = self.belt.length, self.path.length
        if length >= path:
            raise ValueError(
                f"belt.length = {length:.5g} m is longer than the path around the pulleys ({path:.5g} m): "
                "the belt would hang slack. Shorten it, or move the pulleys apart."
            )
        if path / length - 1 > _LARGEST_STRAIN:
            raise ValueError(
                f"belt.length = {length:.5g} m is too short for the path around the pulleys ({path:.5g} m): "
                f"it would be stretched by {path / length - 1:.0%}, and {_LARGEST_STRAIN:.0%} is the limit. "
                "Lengthen it, or move the pulleys together."
            )
        return self

    @model_validator(mode="after")
    def _joint_fits_the_belt(self) -> Self:
        if self.simulation.joint == "multipliers" and self.belt.discretization != "ancf":
            raise ValueError(
                f'simulation.joint = "multipliers" does not fit belt.discretization = "{self.belt.discretization}": '
                'only the element "ancf" has ends to tie. Choose joint = "shared_node", or discretization = "ancf".'
            )
        return self

    @model_validator(mode="after")
    def _tensioners_fit_the_pulleys(self) -> Self:
        check_tensioners(self.tensioners, self.pulleys, self.path)
        return self

    @cached_property
    def path(self) -> Path:
        """The path of the belt around its pulleys."""
        return lay_path(self.pulleys)

    def carried(self, tensioner: AnyTensioner) -> int:
        """Tell the number of the pulley that a tensioner carries."""
        return [pulley.name for pulley in self.pulleys].index(tensioner.pulley)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Instants of kinks and jumps in what is prescribed over time, s, ascending."""
        profiles = [profile for pulley in self.pulleys for profile in pulley.profiles]
        return tuple(sorted({float(t) for profile in profiles for t in profile.breakpoints()}))

    @property
    def frictions(self) -> FloatArray:
        """Coefficients of friction of the pulleys, with the wedge factor on those that touch the inside; shape (n,)."""
        return np.array([friction_on(pulley, self.belt, self.contact) for pulley in self.pulleys])

    @property
    def text(self) -> str:
        """The TOML text that the drive came from, or one that gives the same drive."""
        return self._source or dumps(self)

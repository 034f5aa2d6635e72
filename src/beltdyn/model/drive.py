"""The drive: a belt, its pulleys, their contact, and how to simulate them."""

from collections.abc import Callable
from functools import cached_property
from typing import Any, Self

import numpy as np
import tomli_w
from pydantic import Field, PrivateAttr, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.machines import MovingTensioner, Tensioner
from beltdyn.machines.tensioners.registry import AnyTensioner
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import Carrier, carriers_of
from beltdyn.model.completion import complete, take_up
from beltdyn.model.contact import Contact
from beltdyn.model.layout import radii, trace
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, friction_on
from beltdyn.model.simulation import Simulation
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Acceleration
from beltdyn.parts.text_file import parse_toml


class Drive(Part):
    """A belt drive, complete and consistent.

    The constructor's arguments are `belt`, `pulley` (a list of pulleys, counter-clockwise), `contact`, `tensioner`
    (a list) and `simulation`, each a part or a mapping of its arguments, and `gravity`.

    What may be left open is computed: the length of a belt of given tension, the take-up of a fixed tensioner, which
    moves its pulley, and the stiffness of contact that keeps to an allowed penetration.
    """

    belt: Belt = Field(description="the group [belt]")
    pulleys: tuple[Pulley, ...] = Field(alias="pulley", description="the groups [[pulley]], counter-clockwise")
    contact: Contact = Field(description="the group [contact]")
    tensioners: tuple[AnyTensioner, ...] = Field((), alias="tensioner", description="the groups [[tensioner]]")
    simulation: Simulation = Field(description="the group [simulation]")
    gravity: tuple[Acceleration, Acceleration] = Field(
        (0.0, 0.0), description="the acceleration of gravity as [x, y], in m/s^2"
    )
    _source: str | None = PrivateAttr(None)
    _installed_tension: float | None = PrivateAttr(None)
    _length_given: bool = PrivateAttr(True)
    _tightened: bool = PrivateAttr(False)

    def __reduce__(self) -> tuple[Callable[[str], "Drive"], tuple[str]]:
        """Travel between processes as a drive file."""
        return _from_text, (self.text,)

    @model_validator(mode="after")
    def _becomes_definite(self) -> Self:
        self._installed_tension, self._length_given = self.belt.installed_tension, self.belt.length is not None
        self.__dict__.update(complete(self.belt, self.pulleys, self.contact, self.tensioners))
        return self

    @model_validator(mode="after")
    def _joint_fits_the_belt(self) -> Self:
        if self.simulation.joint == "multipliers" and not self.belt.element_kind.has_ends:
            raise ValueError(
                f'simulation.joint = "multipliers" does not fit belt.discretization = "{self.belt.discretization}": '
                'its elements have no ends to tie. Choose joint = "shared_node", or discretization = "ancf".'
            )
        return self

    @cached_property
    def path(self) -> Path:
        """The path of the line that carries the belt's tension, with spring-loaded tensioners at zero."""
        return trace(self.pulleys, self.belt)

    @cached_property
    def radii(self) -> FloatArray:
        """Effective radii, shape (n,), m: those of the pulleys, and the belt's offset on the side that touches."""
        return radii(self.pulleys, self.belt)

    @cached_property
    def rolling_radii(self) -> FloatArray:
        """Radii R / (1 + e) at which a bent belt without tension rolls on the pulleys, shape (n,), m.

        Bending shortens it by the strain e of `Belt.bent_strain`, so that a rim takes more of it along.
        """
        return np.asarray(self.radii / (1.0 + self.belt.bent_strain(self.radii)))

    @cached_property
    def centers(self) -> FloatArray:
        """Centers of the pulleys, shape (n, 2), m, with spring-loaded tensioners at zero."""
        return np.array([pulley.center for pulley in self.pulleys])

    def _repr_html_(self) -> str:
        """Show the drive in a notebook."""
        from beltdyn.model.notebook import drive_html

        return drive_html(self)

    def replace(self, **changes: Any) -> Self:
        """Make a copy with some values changed, and validate it.

        A tension that was asked for is asked for again, with the length or the take-up computed anew; the drive of a
        run keeps the length that was found for it.

        Parameters
        ----------
        **changes
            The constructor's arguments that differ.

        Returns
        -------
        Drive

        Raises
        ------
        ModelError
            If the changed drive is not valid.

        Examples
        --------
        >>> drive.replace(simulation=drive.simulation.replace(duration=0.5)).simulation.duration
        0.5
        """
        return super().replace(**{"belt": self.belt.given} | changes)

    @property
    def moving_tensioners(self) -> tuple[MovingTensioner, ...]:
        """The tensioners that move while the drive runs."""
        return tuple(one for one in self.tensioners if isinstance(one, MovingTensioner))

    @cached_property
    def carriers(self) -> list[Carrier]:
        """The same with the pulleys that they carry."""
        return carriers_of(self.tensioners, [pulley.name for pulley in self.pulleys], self.path)

    def carried(self, tensioner: Tensioner) -> int:
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
    def installed_tension(self) -> float | None:
        """Tension at rest that was asked for, N: the length of the belt, or a take-up, is computed from it."""
        return self._installed_tension

    def tightened(self, distance: float) -> "Drive":
        """Shorten the belt, or, where its length was given along with the tension, lengthen its path by the take-up.

        Parameters
        ----------
        distance : float
            By how much, m; negative to loosen it.

        Raises
        ------
        ModelError
            If no such belt can run around the pulleys.
        """
        pulleys, length = self.pulleys, self.belt.length
        if self._length_given:
            pulleys = take_up(pulleys, self.tensioners, self.path, distance)
        else:
            length -= distance
        drive = self.replace(belt=self.belt.definite(length, found=True), pulley=pulleys)
        drive._installed_tension, drive._length_given = self._installed_tension, self._length_given
        drive._tightened = True
        return drive

    @property
    def text(self) -> str:
        """The TOML text that the drive came from, or one that gives the same drive.

        A tension that is asked for stays so, until the length or the take-up for it was found (`tightened`).
        """
        return self._source or tomli_w.dumps(self.data, multiline_strings=False)

    @property
    def data(self) -> dict[str, Any]:
        """The groups and keys of a drive file, in SI units and with every default spelled out.

        A tension that is asked for stays so, until the length or the take-up for it was found (`tightened`).
        """
        data = self.model_dump(mode="json", by_alias=True, exclude_none=True)
        if self._installed_tension is not None and not self._tightened:
            data["belt"]["installed_tension"] = self._installed_tension
            if not self._length_given:
                del data["belt"]["length"]
        return data


def _from_text(text: str) -> Drive:
    """The drive of a text that `Drive.text` gave."""
    drive = Drive.model_validate(parse_toml(text))
    drive._source = text
    return drive

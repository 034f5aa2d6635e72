"""The teeth of a synchronous belt: pitch, stiffness and size."""

from math import inf, pi
from typing import Final, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Angle, AngularSpeed, Damping, Force, Length, Ratio, Speed, Stiffness, Words
from beltdyn.theory.rating import mesh_factor, speed_factor

FEWEST_TEETH, MOST_TEETH = 4, 10_000
"""Of a belt or pulley."""
LARGEST_PITCH_ERROR = 0.02
"""Of a pulley, relative."""
SPREAD: Final = "spread"
DISCRETE: Final = "discrete"
"""Laws of teeth: those of every place on the arc, or single ones at their middles."""
USUAL_HEIGHT = 0.4
"""Of a tooth with flanks, over its pitch, about."""
MOST_OFF = 0.01
"""Largest difference of a length from a whole number of pitches, relative, that strain and pitch errors explain."""


class Toothing(Part):
    """The teeth of a belt and how grooves hold them.

    A tooth that is off its groove by δ along the belt is pushed back by `tooth_stiffness` times what δ exceeds half of
    the backlash. The belt runs at the effective radius of a pulley, its teeth times the pitch over 2 π.

    Examples
    --------
    >>> bd.model.Toothing(pitch="8 mm", tooth_stiffness="4e6 N/m").pitch
    0.008
    """

    pitch: Length = Field(gt=0, description="the pitch of belt and pulleys, in m")
    tooth_stiffness: Stiffness = Field(
        gt=0, description="the force on a tooth of the whole width over its deflection along the belt, in N/m"
    )
    tooth_damping: Damping = Field(
        0.0, ge=0, description="the force on a tooth over the rate of its deflection, in N*s/m"
    )
    backlash: Length = Field(0.0, ge=0, description="the play of a tooth in its groove along the belt, in m")
    land_friction: Ratio = Field(
        0.0, ge=0, description="the coefficient of friction of the belt's lands on toothed pulleys"
    )
    tooth_height: Length | None = Field(None, gt=0, description="the height of a tooth, in m")
    flank_angle: Angle = Field(
        0.0,
        ge=0,
        lt=0.5 * pi,
        description="the angle of the flanks to the normal of the pulley, by which teeth push the belt off, in rad",
    )
    law: Literal["spread", "discrete"] = Field(
        SPREAD,
        description="the law of teeth in runs over time: spread over the arc, or discrete, tooth by tooth on a "
        "travelling mesh; other analyses spread them",
    )
    land_radius: Length | None = Field(
        None,
        gt=0,
        description="the radius of the lands of pulleys at the tension line, between which a belt with discrete teeth "
        "runs straight, in m; without it the belt runs on a circle",
    )
    largest_tooth_load: Force | None = Field(
        None, gt=0, description="the allowed force on a tooth of the whole width, in N"
    )
    source: Words | None = Field(None, description="the source of the values, as text")

    @model_validator(mode="after")
    def _has_lands_of_single_teeth(self) -> Self:
        if self.land_radius is not None and self.law != DISCRETE:
            raise ValueError(
                f"land_radius = {1e3 * self.land_radius:.5g} mm needs discrete teeth: spread ones hold the belt on "
                f'circles. Set law = "{DISCRETE}", or omit land_radius'
            )
        return self

    @model_validator(mode="after")
    def _has_less_play_than_grooves(self) -> Self:
        if self.backlash >= 0.5 * self.pitch:
            raise ValueError(
                f"backlash = {1e3 * self.backlash:.5g} mm must be below half of the pitch of {1e3 * self.pitch:.5g} "
                "mm: grooves that wide hold no tooth. Reduce it"
            )
        return self

    @property
    def reach(self) -> float:
        """Lift of the belt off the rim at which a tooth is out of its groove, m."""
        if self.tooth_height is not None:
            return self.tooth_height
        return USUAL_HEIGHT * self.pitch if self.flank_angle > 0.0 else 0.0

    def times(self, width: float) -> Self:
        """The same teeth of a belt so many times as wide."""
        most = self.largest_tooth_load
        return self.replace(
            tooth_stiffness=width * self.tooth_stiffness,
            tooth_damping=width * self.tooth_damping,
            largest_tooth_load=None if most is None else width * most,
        )

    def radius(self, teeth: int, pitch_error: float, offset: float) -> float:
        """Radius of the outside of a pulley, m, whose tension line lies outside of it by an offset, m."""
        return teeth * self.pitch * (1.0 + pitch_error) / (2.0 * pi) - offset

    def teeth_about(self, radius: float, offset: float) -> int:
        """Number of teeth of the pulley whose `radius` is nearest to one, m."""
        return min(max(round(2.0 * pi * (radius + offset) / self.pitch), FEWEST_TEETH), MOST_TEETH)


class ToothRating(Part):
    """How the teeth of a profile are rated, with standard widths; the law is that of `beltdyn.theory.rating`.

    Examples
    --------
    >>> rating = bd.read_catalogue()["HTD 8M"].tooth_rating
    >>> rating.counted_teeth, rating.next_width(0.024)
    (6.0, 0.03)
    """

    counted_teeth: Ratio = Field(gt=0, description="the largest number of teeth in mesh that counts")
    speed_loss: Ratio = Field(
        0.0, ge=0, lt=1, description="the relative loss of the allowed tooth load for ten times the pulley speed"
    )
    loss_speed: AngularSpeed | None = Field(
        None, gt=0, description="the pulley speed from which on the allowed tooth load falls, in rad/s"
    )
    largest_speed: Speed = Field(gt=0, description="the largest belt speed, in m/s")
    widths: tuple[Length, ...] = Field((), description="the standard widths, in m")
    source: str = Field(min_length=1, description="the source of the rating, as text")

    def next_width(self, width: float) -> float:
        """The next standard width, m; the width itself without standard widths, infinite beyond them."""
        if not self.widths:
            return width
        return min((one for one in self.widths if one >= width * (1.0 - 1e-9)), default=inf)

    def load_factor(self, speed: FloatArray | float) -> FloatArray:
        """Allowed load of a tooth over that at rest, for speeds of a pulley in rad/s."""
        if self.loss_speed is None:
            return np.ones_like(np.asarray(speed, dtype=float))
        return speed_factor(speed, self.speed_loss, self.loss_speed)


class MeshRating(NamedTuple):
    """The rating of a toothed belt on each of n pulleys, arrays of shape (n,)."""

    diameter: FloatArray
    """Of the tension line, m."""
    wrap: FloatArray
    """Wrap angle, rad."""
    in_mesh: FloatArray
    """Pitches on the arc."""
    mesh_factor: FloatArray
    """Of the teeth in mesh that count."""
    load: FloatArray
    """Allowed on a tooth at the speed of the pulley, N."""
    pull: FloatArray
    """Allowed, N."""
    power: FloatArray
    """W."""

    def on(self, pulleys: BoolArray) -> "MeshRating":
        """That of some pulleys; NaN for others."""
        kept = (np.where(pulleys, one, np.nan) for one in self[2:])
        return MeshRating(self.diameter, self.wrap, *kept)

    def outside(self, pulleys: BoolArray) -> "MeshRating":
        """The same with no load on some pulleys, which lie outside the rating."""
        load, pull, power = (np.where(pulleys, 0.0, one) for one in (self.load, self.pull, self.power))
        return self._replace(load=load, pull=pull, power=power)


class RatedTeeth(NamedTuple):
    """A toothed belt as it is rated."""

    rating: ToothRating
    toothing: Toothing
    """Of the width of the belt."""
    width: float
    """m."""
    mass: float
    """Per length, kg/m."""
    largest_tension: float | None
    """Allowed, N."""

    def on(self, diameters: FloatArray, wraps: FloatArray, speed: float, loaded: BoolArray) -> MeshRating:
        """Rate the belt on pulleys with diameters of its tension line (m), wrap angles (rad) and a belt speed (m/s)."""
        counted, allowed = self.rating.counted_teeth, self.toothing.largest_tooth_load or 0.0
        in_mesh = 0.5 * diameters * wraps / self.toothing.pitch
        factor = mesh_factor(in_mesh, counted)
        load = allowed * self.rating.load_factor(2.0 * speed / diameters)
        held = np.minimum(factor * counted * load, self.largest_tension or np.inf)
        pull = np.maximum(held - self.mass * speed**2, 0.0)
        return MeshRating(diameters, wraps, in_mesh, factor, load, pull, pull * speed)

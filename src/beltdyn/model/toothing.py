"""The teeth of a synchronous belt: pitch, stiffness and size."""

from math import pi
from typing import Final, Literal, Self

from pydantic import Field, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Angle, Damping, Force, Length, Ratio, Stiffness, Words

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

"""The power rating of a profile, and that of a belt on its pulleys."""

from typing import NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Length, MassPerLength, Ratio, Speed, Torque
from beltdyn.theory.rating import (
    RatingLaw,
    belts_factor,
    pulleys_factor,
    rated_force,
    ratio_force,
    wrap_factor,
)

_SLOWEST = 1e-3
"""Belt speed below which a belt carries no power, m/s."""
_ROUNDING = 1e-12
MOST_BELTS = 1000
"""Ribs or V-belts side by side that a belt may have."""


class Rating(Part):
    """The power rating of a profile, of one rib or V-belt: coefficients of the law of `beltdyn.theory.rating`.

    Examples
    --------
    >>> rating = bd.read_catalogue()["SPA"].rating
    >>> round(float(rating.power(0.100, speed=5.236)))  # W on 100 mm at 1000 rpm
    2421
    """

    force: Force = Field(gt=0, description="the rated pull c1 at 1 m/s without bending, in N")
    bending: Torque = Field(ge=0, description="the coefficient c2 of the loss by bending, in N*m")
    centrifugal: MassPerLength = Field(ge=0, description="the coefficient c3 of the centrifugal loss, in kg/m")
    speed: Force = Field(ge=0, description="the loss c4 of pull for ten times the belt speed, in N")
    ratio_exponent: Ratio = Field(
        gt=0, description="the exponent x of the diameter in the damage by a pulley, for unequal pulleys"
    )
    reference_length: Length | None = Field(
        None,
        gt=0,
        description="the nominal length whose length factor is 1; by default there is no length factor, in m",
    )
    length_exponent: Ratio = Field(0.0, ge=0, lt=1, description="the exponent of the nominal length in its factor")
    largest_diameter: Length | None = Field(
        None, gt=0, description="the largest pulley of the source, whose rated pull larger ones have too, in m"
    )
    largest_speed: Speed = Field(gt=0, description="the belt speed up to which the rating holds, in m/s")
    source: str = Field(min_length=1, description="the source of the rating, as text")

    @model_validator(mode="after")
    def _has_its_length(self) -> Self:
        if self.length_exponent > 0 and self.reference_length is None:
            raise ValueError(
                f"length_exponent = {self.length_exponent:g} needs reference_length. Give it, or omit length_exponent"
            )
        return self

    @property
    def law(self) -> RatingLaw:
        """Coefficients of the law."""
        return RatingLaw(self.force, self.bending, self.centrifugal, self.speed)

    def power(self, diameter: FloatArray | float, speed: float, ratio: FloatArray | float = 1.0) -> FloatArray:
        """Rated power of one rib or V-belt of the reference length with half a turn of wrap, W; at least zero.

        Parameters
        ----------
        diameter : array_like
            Of the tension line on the pulley, m.
        speed : float
            Of the belt, m/s.
        ratio : array_like, default 1
            Of the diameter of a larger pulley to this one, at least 1.
        """
        if not speed > _SLOWEST:
            return np.zeros(np.broadcast(diameter, ratio).shape)
        known = np.minimum(diameter, self.largest_diameter or np.inf)
        pull = rated_force(self.law, known, speed) + ratio_force(self.law, known, ratio, self.ratio_exponent)
        return np.asarray(speed * np.maximum(pull, 0.0))

    def length_factor(self, nominal_length: float) -> float:
        """Factor on the rated power for the length of a belt: long belts bend less often."""
        if self.reference_length is None:
            return 1.0
        return float((nominal_length / self.reference_length) ** self.length_exponent)


class PowerRating(NamedTuple):
    """The rating of a belt on each of n pulleys, arrays of shape (n,)."""

    diameter: FloatArray
    """Of the tension line, m."""
    basic: FloatArray
    """Power of one rib or V-belt on equal pulleys, W."""
    ratio: FloatArray
    """What it gains by a larger pulley, W."""
    wrap: FloatArray
    """Wrap angle, rad."""
    wrap_factor: FloatArray
    power: FloatArray
    """Of the whole belt, with all factors, W."""

    def on(self, pulleys: BoolArray) -> "PowerRating":
        """That of some pulleys; NaN for others."""
        basic, ratio, power = (np.where(pulleys, one, np.nan) for one in (self.basic, self.ratio, self.power))
        return self._replace(basic=basic, ratio=ratio, power=power)


class RatedBelt(NamedTuple):
    """A belt as it is rated."""

    rating: Rating
    belts: int
    """Ribs of the belt, or V-belts side by side."""
    in_set: bool
    """Whether these are V-belts side by side, which share the load unequally."""
    nominal_length: float
    """m."""

    def on(self, diameters: FloatArray, wraps: FloatArray, speed: float, loaded: BoolArray) -> PowerRating:
        """Rate the belt on pulleys with diameters of its tension line (m), wrap angles (rad) and a belt speed (m/s).

        The largest loaded pulley counts in the ratio.
        """
        largest = np.max(diameters, where=loaded, initial=0.0)
        basic = self.rating.power(diameters, speed)
        more = self.rating.power(diameters, speed, np.maximum(largest / diameters, 1.0)) - basic
        factor = wrap_factor(wraps)
        whole = (basic + more) * factor * self.factor(self.belts, diameters.size)
        return PowerRating(diameters, basic, more, wraps, factor, whole)

    def factor(self, belts: int, pulleys: int) -> float:
        """Rated power of belts on so many pulleys, over that of one belt of the reference length on two."""
        shared = belts_factor(belts) if self.in_set else 1.0
        return belts * shared * pulleys_factor(pulleys) * self.rating.length_factor(self.nominal_length)

    def belts_needed(self, utilization: float, pulleys: int) -> int:
        """Least number of belts or ribs that carry what is this share of the rated power of the present ones."""
        needed = utilization * self.factor(self.belts, pulleys) * (1.0 - _ROUNDING)
        return next((count for count in range(1, MOST_BELTS) if self.factor(count, pulleys) >= needed), MOST_BELTS)

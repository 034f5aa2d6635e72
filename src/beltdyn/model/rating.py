"""Data of a belt from its maker or from tests: power rating, fatigue of cords and ribs, tension over strain."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import ConfigDict, Field, ValidationError, ValidationInfo, model_validator

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Force,
    Length,
    MassPerLength,
    Ratio,
    Speed,
    Temperature,
    TemperatureDifference,
    Torque,
    Words,
)
from beltdyn.parts.table_file import check_points, describe_file, take_file
from beltdyn.stretch import StretchParameters, through
from beltdyn.theory.rating import (
    RatingLaw,
    belts_factor,
    pulleys_factor,
    rated_force,
    ratio_force,
    wrap_factor,
)

_MIN_SPEED = 1e-3
"""Belt speed below which a belt carries no power, m/s."""
_POWER_TOLERANCE = 1e-12
"""Relative shortfall of the rated power that counts as none, so that rounding asks for no additional belt."""
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
    of_profile: Words | None = Field(
        None, description="the profile from which the rating is taken, if it is a lower bound of that of the belt"
    )
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
        if not speed > _MIN_SPEED:
            return np.zeros(np.broadcast(diameter, ratio).shape)
        known = np.minimum(diameter, self.largest_diameter or np.inf)
        pull = rated_force(self.law, known, speed) + ratio_force(self.law, known, ratio, self.ratio_exponent)
        return np.asarray(speed * np.maximum(pull, 0.0))

    def length_factor(self, nominal_length: float) -> float:
        """Factor on the rated power for the length of a belt: long belts bend less often."""
        if self.reference_length is None:
            return 1.0
        return float((nominal_length / self.reference_length) ** self.length_exponent)


def lower_bound(profile: str) -> str:
    """Say that a belt is rated as another profile, of which its rating is a lower bound."""
    return (
        f"The rating is that of the wrapped belt {profile}, a lower bound: cogged belts with raw edges carry more, on "
        "small pulleys up to twice as much. Count the belts by the table of your supplier, in a catalogue of your own."
    )


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

    def outside(self, pulleys: BoolArray) -> "PowerRating":
        """The same with no power on some pulleys, which lie outside the rating."""
        basic, ratio, power = (np.where(pulleys, 0.0, one) for one in (self.basic, self.ratio, self.power))
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
        needed = utilization * self.factor(self.belts, pulleys) * (1.0 - _POWER_TOLERANCE)
        return next((count for count in range(1, MOST_BELTS) if self.factor(count, pulleys) >= needed), MOST_BELTS)


Survival = Annotated[Ratio, Field(gt=0, lt=1)]
Source = Annotated[Words, Field(min_length=1)]


def _life_name(survival: float | None) -> str:
    """The life that a share of belts reaches, such as "B10"; "life" if the share is unknown."""
    return "life" if survival is None else f"B{100.0 * (1.0 - survival):.3g} life"


class CordFatigue(Part):
    """An S-N line of the cords of the whole belt.

    The force in the cords is F = T + `bending_force` ``|κ|``, with the tension T and the curvature κ of a material
    point. A cycle between F₁ and F₂ counts as the force F₂ (1 − F₁/F₂)^γ (Walker) with γ = `range_exponent`. The cycles
    to failure at this force are read from the points, on straight lines over the logarithms of both.

    Examples
    --------
    >>> line = bd.model.CordFatigue(cycles=[1e8, 1e9], forces=[100.0, 80.0], bending_force=0.5, source="data sheet")
    >>> f"{line.cycles_to_failure(80.0):.4g}"
    '1e+09'
    """

    cycles: tuple[Ratio, ...] = Field(min_length=2, description="the cycles to failure of the points, ascending")
    forces: tuple[Force, ...] = Field(
        min_length=2, description="the forces in the cords at which they fail, descending, in N"
    )
    bending_force: Torque = Field(
        ge=0, description="the force in the cords by bending, times the radius of the tension line, in N*m"
    )
    range_exponent: Ratio = Field(
        0.0,
        ge=0,
        le=1,
        description="the exponent of the range of a cycle over its largest force (Walker); with 0 the largest force "
        "alone counts, with 1 the range",
    )
    survival: Survival | None = Field(
        None, description="the share of belts that reach these cycles, 0.9 for a B10 life; none if it is unknown"
    )
    source: Source = Field(description="the source of the values, as text")

    @model_validator(mode="after")
    def _is_a_line(self) -> Self:
        check_points("cycles", self.cycles, "forces", self.forces)
        if min(self.cycles) <= 0 or min(self.forces) <= 0:
            raise ValueError("cycles and forces must be positive. Correct the points of the S-N line")
        for earlier, later in pairwise(self.forces):
            if later >= earlier:
                raise ValueError(f"forces must decrease, but {later:g} N follows {earlier:g} N. Sort the points")
        return self

    @property
    def life_name(self) -> str:
        """The life that it gives, such as "B10 life"."""
        return _life_name(self.survival)

    def times(self, factor: float) -> "CordFatigue":
        """The line of a belt with so many times the cords."""
        forces = tuple(factor * force for force in self.forces)
        return self.replace(forces=forces, bending_force=factor * self.bending_force)

    def equivalent_force(self, low: ArrayLike, high: ArrayLike) -> FloatArray:
        """The force as which a cycle counts, N.

        Parameters
        ----------
        low, high : array_like, shape (...)
            Least and largest force of the cycle, N; `high` is positive.
        """
        low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
        return np.asarray(high * (1.0 - low / high) ** self.range_exponent)

    def cycles_to_failure(self, force: ArrayLike) -> FloatArray:
        """Cycles to failure at an equivalent force (N), beyond the points on the lines of the first and the last two.

        Parameters
        ----------
        force : array_like, shape (...)
            N, not negative.
        """
        points, cycles = np.log(self.forces[::-1]), np.log(self.cycles[::-1])
        with np.errstate(divide="ignore", over="ignore"):  # no force, no failure
            along = np.log(np.asarray(force, dtype=float))
            piece = np.clip(np.searchsorted(points, along) - 1, 0, len(points) - 2)
            slope = np.diff(cycles)[piece] / np.diff(points)[piece]
            return np.asarray(np.exp(cycles[piece] + slope * (along - points[piece])))


class RibFatigue(Part):
    """The law of the fatigue of ribs by bending, tension and heat.

    A passage over a pulley of diameter d at the tension T and the temperature θ counts as
    (d/`diameter`)^−`diameter_exponent` (T/`tension`)^`tension_exponent` 2^((θ − `temperature`)/`halving_difference`)
    passages of the reference condition, and times `back_factor` on a pulley at the back. The reference condition
    cancels in relative lives; for a life in hours it needs the number of `passages` to failure.

    Examples
    --------
    >>> law = bd.model.RibFatigue(diameter=0.1, tension=100.0, temperature=80.0, source="data sheet")
    >>> round(float(law.passages_at(100.0, 0.05)), 2)  # half the diameter: 2^5.6
    48.5
    """

    diameter_exponent: Ratio = Field(5.6, ge=0, description="the exponent of the pulley diameter in the life")
    tension_exponent: Ratio = Field(1.13, ge=0, description="the exponent of the tension in the damage")
    halving_difference: TemperatureDifference = Field(
        23.0, gt=0, le=200, description="the temperature difference that halves the life, in K"
    )
    back_factor: Ratio = Field(0.3, ge=0, description="the damage by a pulley at the back over that by one inside")
    diameter: Length = Field(gt=0, description="the pulley diameter of the reference condition, in m")
    tension: Force = Field(gt=0, description="the tension of the reference condition, in N")
    temperature: Temperature = Field(description="the temperature of the reference condition, in °C")
    passages: Ratio | None = Field(
        None, gt=0, description="the passages over a pulley to failure in the reference condition; none if unknown"
    )
    survival: Survival | None = Field(
        None, description="the share of belts that reach these passages, 0.9 for a B10 life; none if it is unknown"
    )
    source: Source = Field(description="the source of the values, as text")

    @property
    def life_name(self) -> str:
        """The life that it gives, such as "B10 life"."""
        return _life_name(self.survival)

    def times(self, factor: float) -> "RibFatigue":
        """The law of a belt with so many times the ribs."""
        return self.replace(tension=factor * self.tension)

    def passages_at(
        self,
        tension: ArrayLike,
        diameter: ArrayLike,
        temperature: float | None = None,
        sides: Sequence[str] | str = "inside",
    ) -> FloatArray:
        """Passages of the reference condition as which a passage over a pulley counts.

        Parameters
        ----------
        tension : array_like, shape (...)
            N; none counts where it is negative.
        diameter : array_like, shape (...)
            Of the pulley as sold, m.
        temperature : float, optional
            Of the belt, °C; by default that of the reference condition.
        sides : sequence of str or str
            "inside" or "outside" (the back), of each pulley or of all.
        """
        pull = np.maximum(np.asarray(tension, dtype=float) / self.tension, 0.0) ** self.tension_exponent
        bend = (np.asarray(diameter, dtype=float) / self.diameter) ** -self.diameter_exponent
        heat = 0.0 if temperature is None else (temperature - self.temperature) / self.halving_difference
        back = np.where(np.asarray(sides) == "outside", self.back_factor, 1.0)
        return np.asarray(pull * bend * 2.0**heat * back)


class StretchCurve(Part):
    """Measured tension over strain of the whole belt, a smooth curve through its points.

    The points are `strains` and `tensions`, or the two columns of the CSV file `file`: a relative path starts at the
    folder of the drive file. The point without strain and tension may be left out.

    Examples
    --------
    >>> from beltdyn.model.rating import StretchCurve
    >>> StretchCurve(strains=[0.005, 0.01], tensions=["400 N", "750 N"]).tensions
    (400.0, 750.0)
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(
            schema, ("strains", "tensions"), "two columns, strains and tensions"
        )
    )

    strains: tuple[Ratio, ...] = Field(
        min_length=1, description="the elongations of the points over the unstretched length, ascending"
    )
    tensions: tuple[Force, ...] = Field(min_length=1, description="the tensions at these strains, ascending, in N")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "strains", "tensions")

    @model_validator(mode="after")
    def _is_a_law(self) -> Self:
        check_points("strains", self.strains, "tensions", self.tensions)
        strains, tensions = self._points
        if self.strains[0] < 0 or (self.strains[0] == 0 and self.tensions[0] != 0):
            raise ValueError(
                f"the first point has the strain {self.strains[0]:g} and the tension {self.tensions[0]:g} N, but a "
                "curve must start at the origin. Measure the strain from the unstretched length"
            )
        for (_, before), (strain, after) in pairwise(zip(strains, tensions, strict=True)):
            if after <= before:
                raise ValueError(
                    f"tensions must increase, but {after:g} N at the strain {strain:g} follows {before:g} N. Use the "
                    "loading curve, and smooth it"
                )
        if len(strains) < 2:
            raise ValueError("the curve has no point above zero strain. Give at least one")
        return self

    @property
    def _points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The points, with the one without strain."""
        if self.strains[0] == 0:
            return self.strains, self.tensions
        return (0.0, *self.strains), (0.0, *self.tensions)

    def times(self, factor: float) -> "StretchCurve":
        """The curve scaled in tension."""
        return StretchCurve(strains=self.strains, tensions=tuple(factor * tension for tension in self.tensions))

    @cached_property
    def parameters(self) -> StretchParameters:
        """Parameters of the law of stretch."""
        return through(*self._points)


def with_initial_slope(data: Any, base: Path | None) -> Any:
    """Set the axial stiffness of a belt with a measured curve to the initial slope of the curve."""
    if not isinstance(data, Mapping) or "stretch_curve" not in data:
        return data
    if "axial_stiffness" in data:
        raise ValueError(
            "axial_stiffness and stretch_curve exclude each other: the curve gives the stiffness. Keep one of them"
        )
    try:
        curve = StretchCurve.model_validate(data["stretch_curve"], context={"base": base})
    except ValidationError:
        return {**data, "axial_stiffness": 1.0}  # the field of the belt tells what is wrong with the curve
    return {**data, "stretch_curve": curve, "axial_stiffness": curve.parameters.stiffness}

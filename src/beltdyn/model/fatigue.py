"""Fatigue data of a belt: the S-N line of its cords, and the law of rib fatigue."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Length, Ratio, Temperature, TemperatureDifference, Torque, Words
from beltdyn.parts.table_file import check_points

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

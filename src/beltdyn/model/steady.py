"""The mesh of steady running."""

from typing import Literal, Self

from pydantic import Field, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Ratio


class Steady(Part):
    """The mesh of steady running, of maps and of all other analyses based on it.

    Examples
    --------
    >>> bd.Steady(force_tolerance=0.02).force_tolerance
    0.02
    """

    mesh: Literal["auto", "uniform"] = Field(
        "auto",
        description="the mesh: graded towards the ends of arcs and refined by the solution, or `belt.elements` equal "
        "elements, as published",
    )
    force_tolerance: Ratio | None = Field(
        None,
        gt=0,
        lt=1,
        description="the error of contact forces, over the largest force on a pulley, to which the mesh is refined, "
        "below 1; 0.01 by default",
    )

    @model_validator(mode="after")
    def _is_refined_or_not(self) -> Self:
        if self.mesh == "uniform" and self.force_tolerance is not None:
            raise ValueError(
                f'force_tolerance = {self.force_tolerance:g} is incompatible with mesh = "uniform", which is not '
                'refined. Remove it, or set mesh = "auto"'
            )
        return self

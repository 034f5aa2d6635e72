"""A measured curve of tension over strain."""

from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, Self

from pydantic import ConfigDict, Field, ValidationError, ValidationInfo, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Ratio
from beltdyn.parts.table_file import check_points, describe_file, take_file
from beltdyn.stretch import StretchParameters, through


class StretchCurve(Part):
    """Measured tension over strain of the whole belt, a smooth curve through its points.

    The points are `strains` and `tensions`, or the two columns of the CSV file `file`: a relative path starts at the
    folder of the drive file. The point without strain and tension may be left out.

    Examples
    --------
    >>> from beltdyn.model.stretch_curve import StretchCurve
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

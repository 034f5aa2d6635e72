"""Limits of the results of a drive."""

from typing import Self

from pydantic import Field, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Ratio


class Limits(Part):
    """Limits of results, checked by reports. They do not affect computed results.

    Examples
    --------
    >>> bd.Limits(largest_hub_load="0.8 kN", largest_slip=0.01).largest_hub_load
    800.0
    """

    largest_slip: Ratio | None = Field(
        None, gt=0, lt=1, description="the largest slip of a pulley against the first one, over its speed"
    )
    largest_hub_load: Force | None = Field(None, gt=0, description="the largest hub load at any time, in N")
    largest_tension: Force | None = Field(None, gt=0, description="the largest span tension at any time, in N")
    least_tension: Force | None = Field(None, ge=0, description="the least span tension at any time, in N")
    least_margin: Ratio | None = Field(
        None, gt=0, description="the least capstan margin: the factor on all loads at which gross slip begins"
    )

    @model_validator(mode="after")
    def _leave_room(self) -> Self:
        least, largest = self.least_tension, self.largest_tension
        if least is not None and largest is not None and not least < largest:
            raise ValueError(
                f"least_tension = {least:g} N must be below largest_tension = {largest:g} N. Change one of them"
            )
        return self

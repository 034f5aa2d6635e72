"""What a drive must keep to, by which its results are judged."""

from typing import Self

from pydantic import Field, model_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Ratio


class Limits(Part):
    """What a drive must keep to. Nothing that is computed depends on it; reports judge results by it.

    Examples
    --------
    >>> bd.Limits(largest_hub_load="0.8 kN", largest_slip=0.01).largest_hub_load
    800.0
    """

    largest_slip: Ratio | None = Field(
        None, gt=0, lt=1, description="the largest slip of a pulley against the first one, over that one's speed"
    )
    largest_hub_load: Force | None = Field(
        None, gt=0, description="the largest force of the belt on a pulley at any time, in N"
    )
    largest_tension: Force | None = Field(None, gt=0, description="the largest tension of a span at any time, in N")
    least_tension: Force | None = Field(None, ge=0, description="the least tension of a span at any time, in N")
    least_margin: Ratio | None = Field(
        None, gt=0, description="the least capstan margin: the factor on all loads at which the belt slides through"
    )

    @model_validator(mode="after")
    def _leave_room(self) -> Self:
        least, largest = self.least_tension, self.largest_tension
        if least is not None and largest is not None and not least < largest:
            raise ValueError(
                f"least_tension = {least:g} N is not below largest_tension = {largest:g} N, which no drive can keep "
                "to. Change one"
            )
        return self

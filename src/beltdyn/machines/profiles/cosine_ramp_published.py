"""The cosine rise as the paper prints it (Eq. 29)."""

from typing import ClassVar, Generic, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.machines.profiles.profile import SEGMENT, Value
from beltdyn.machines.profiles.rise import Rise
from beltdyn.records import Records, records


class CosineRampPublished(Rise[Value], Generic[Value]):
    """The rise of Eq. (29) as printed: its cosine runs from time zero to `end`, so it jumps at `start`.

    Examples
    --------
    >>> bd.CosineRampPublished(start=0.0, end=2.0, value=10.0).at([0.0, 1.0, 2.0]).round(6)
    array([ 0.,  5., 10.])
    """

    multiplies: ClassVar[bool] = False

    kind: Literal["cosine_ramp_published"] = Field("cosine_ramp_published", description="the kind of profile")

    @model_validator(mode="after")
    def _ends_after_time_zero(self) -> Self:
        if self.end <= 0:
            raise ValueError(f"end = {self.end:g} s must be later than time zero. Increase end, or use cosine_ramp")
        return self

    def segments(self) -> Records:
        """Zero, then value/2 (1 - cos(pi t / end)), then value: Eq. (29)."""
        half = self.value / 2
        return records(
            SEGMENT,
            start=[-np.inf, self.start, self.end],
            offset=[0.0, half, float(self.value)],
            amplitude=[0.0, -half, 0.0],
            frequency=[0.0, np.pi / self.end, 0.0],
        )

"""A linear rise (Eq. 28)."""

from typing import Generic, Literal

import numpy as np
from pydantic import Field

from beltdyn.machines.profiles.profile import SEGMENT, Value
from beltdyn.machines.profiles.rise import Rise
from beltdyn.records import Records, records


class Ramp(Rise[Value], Generic[Value]):
    """A linear rise from zero at `start` to `value` at `end`, Eq. (28).

    Examples
    --------
    >>> bd.Ramp(start=0.0, end=2.0, value=10.0).at([0.5, 1.0, 3.0])
    array([ 2.5,  5. , 10. ])
    """

    kind: Literal["ramp"] = Field("ramp", description="the kind of profile")

    def segments(self) -> Records:
        """Zero, then value (t - start) / (end - start), then value: Eq. (28)."""
        slope = self.value / (self.end - self.start)
        starts = [-np.inf, self.start, self.end]
        return records(SEGMENT, start=starts, offset=[0.0, 0.0, float(self.value)], slope=[0.0, slope, 0.0])

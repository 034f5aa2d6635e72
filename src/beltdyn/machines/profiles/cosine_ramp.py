"""A smooth rise along half a cosine."""

from typing import Generic, Literal

import numpy as np
from pydantic import Field

from beltdyn.machines.profiles.profile import SEGMENT, Value
from beltdyn.machines.profiles.rise import Rise
from beltdyn.records import Records, records


class CosineRamp(Rise[Value], Generic[Value]):
    """A smooth rise from zero at `start` to `value` at `end`, along half a cosine from start to end.

    Examples
    --------
    >>> bd.CosineRamp(start=0.0, end=2.0, value=10.0).at([0.0, 1.0, 2.0]).round(6)
    array([ 0.,  5., 10.])
    """

    kind: Literal["cosine_ramp"] = Field("cosine_ramp", description="the kind of profile")

    def segments(self) -> Records:
        """Zero, then value/2 (1 - cos(pi (t - start) / (end - start))), then value."""
        omega = np.pi / (self.end - self.start)
        half = self.value / 2
        return records(
            SEGMENT,
            start=[-np.inf, self.start, self.end],
            offset=[0.0, half, float(self.value)],
            amplitude=[0.0, -half, 0.0],
            frequency=[0.0, omega, 0.0],
            phase=[0.0, -omega * self.start, 0.0],
        )

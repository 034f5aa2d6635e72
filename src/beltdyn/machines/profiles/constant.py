"""A constant value."""

from typing import Generic, Literal

import numpy as np
from pydantic import Field

from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
from beltdyn.records import Records, records


class Constant(Profile[Value], Generic[Value]):
    """The same value at all times.

    Examples
    --------
    >>> bd.Constant(value=3.0).at([0.0, 1.0])
    array([3., 3.])
    """

    kind: Literal["constant"] = Field("constant", description="the kind of profile")
    value: Value = Field(description="the value at all times")

    def segments(self) -> Records:
        """One piece: value(t) = value."""
        return records(SEGMENT, start=[-np.inf], offset=[self.value])

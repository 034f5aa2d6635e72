"""A guide along a span, on which the belt slides: mu (n + p) against the motion."""

from typing import Literal

import numpy as np
from pydantic import Field

from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.carrying.support import LineForce, Support, dry_resistance
from beltdyn.parts.quantity import Ratio, Speed, Stiffness
from beltdyn.records import record

GUIDE = record(
    friction="f8",  # mu
    pressing="f8",  # p, N/m
    creep_speed="f8",  # m/s
)


@kernel
def guide_resistance(constants: np.record, normal: float, speed: float) -> LineForce:
    """Friction of a guide.

    Parameters
    ----------
    constants
        A row of `GUIDE`.
    normal
        n, N/m.
    speed
        v, m/s.
    """
    limit = constants.friction * (normal + constants.pressing)
    return dry_resistance(limit, constants.friction, speed, constants.creep_speed)


@register
class Guide(Support):
    """A guide or slider bed along a span, which holds the belt on both sides.

    Examples
    --------
    >>> bd.model.Guide(kind="guide", span=["newel", "drive"], friction=0.2, pressing="15 N/m").pressing
    15.0
    """

    constants = GUIDE
    resistance_at = guide_resistance

    kind: Literal["guide"] = Field(description="the kind of support")
    friction: Ratio = Field(ge=0, description="the coefficient of friction between belt and guide")
    pressing: Stiffness = Field(
        0.0, ge=0, description="the normal force of clamping, besides that of weight and curvature, in N/m"
    )
    creep_speed: Speed = Field(0.01, gt=0, description="the speed at which friction reaches 76 %, in m/s")

"""A coupling that gets stiffer with its twist: k twist + k3 twist^3 + c rate."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from beltdyn.extend import HubLink, LinkTorque, kernel, quantity, record, register
from beltdyn.parts.quantity import TorsionalDamping, TorsionalStiffness

PROGRESSIVE_COUPLING = record(
    stiffness="f8",  # k, N m/rad
    cubic_stiffness="f8",  # k3, N m/rad^3
    damping="f8",  # c, N m s/rad
)


@kernel
def progressive_coupling(constants: np.record, _scale: float, twist: float, rate: float) -> LinkTorque:
    """Torque of the coupling; constants are a row of `PROGRESSIVE_COUPLING`."""
    square, cubic = twist * twist, constants.cubic_stiffness
    damper = constants.damping * rate
    return LinkTorque(
        torque=(constants.stiffness + cubic * square) * twist + damper,
        by_twist=constants.stiffness + 3.0 * cubic * square,
        by_rate=constants.damping,
        by_schedule=0.0,
        energy=(0.5 * constants.stiffness + 0.25 * cubic * square) * square,
        loss=damper * rate,
    )


@register
class ProgressiveCoupling(HubLink):
    """A torsional spring that gets stiffer with its twist, and a damper in parallel."""

    constants = PROGRESSIVE_COUPLING
    torque_at = progressive_coupling

    kind: Literal["progressive_coupling"] = Field(description="the kind of link")
    stiffness: TorsionalStiffness = Field(gt=0, description="the torque over a small twist, in N*m/rad")
    cubic_stiffness: Annotated[float, quantity("N*m/rad**3")] = Field(
        ge=0, description="the torque over the third power of the twist, in N*m/rad^3"
    )
    damping: TorsionalDamping = Field(0.0, ge=0, description="the torque over the rate of twist, in N m s/rad")

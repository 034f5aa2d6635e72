"""A torsional isolator: linear spring and damper in parallel, k twist + c rate."""

from typing import Literal

import numpy as np
from pydantic import Field

from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.links.link import HubLink, LinkTorque
from beltdyn.parts.quantity import TorsionalDamping, TorsionalStiffness
from beltdyn.records import record

ISOLATOR = record(
    stiffness="f8",  # k, N m/rad
    damping="f8",  # c, N m s/rad
)


@kernel
def isolator(constants: np.record, _scale: float, twist: float, rate: float) -> LinkTorque:
    """Torque of spring and damper; arguments as for `HubLink.torque_at`, constants a row of `ISOLATOR`."""
    spring, damper = constants.stiffness * twist, constants.damping * rate
    return LinkTorque(
        torque=spring + damper,
        by_twist=constants.stiffness,
        by_rate=constants.damping,
        by_schedule=0.0,
        energy=0.5 * spring * twist,
        loss=damper * rate,
    )


@register
class Isolator(HubLink):
    """A torsional spring and damper in parallel.

    Examples
    --------
    >>> bd.model.Isolator(kind="isolator", stiffness="200 N m/rad", damping=0.5, inertia="20 kg cm^2").stiffness
    200.0
    """

    constants = ISOLATOR
    torque_at = isolator

    kind: Literal["isolator"] = Field(description="the kind of link")
    stiffness: TorsionalStiffness = Field(gt=0, description="the torque over the twist, in N*m/rad")
    damping: TorsionalDamping = Field(0.0, ge=0, description="the torque over the twist rate, in N m s/rad")

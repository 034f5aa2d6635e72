"""A clutch that slips at its capacity: c rate between -capacity and +capacity, which a schedule multiplies."""

from typing import Literal

import numpy as np
from pydantic import Field

from beltdyn.kernel import kernel
from beltdyn.machines.links.link import HubLink, LinkTorque
from beltdyn.machines.profiles.registry import Schedule
from beltdyn.parts.quantity import Torque, TorsionalDamping
from beltdyn.records import record

FRICTION_CLUTCH = record(
    locking_damping="f8",  # c, N m s/rad
    capacity="f8",  # largest torque, N m
)


@kernel
def friction_clutch(constants: np.record, scale: float, _twist: float, rate: float) -> LinkTorque:
    """Torque of the clutch; arguments as for `HubLink.torque_at`, constants a row of `FRICTION_CLUTCH`."""
    torque, slope, by_schedule = constants.locking_damping * rate, constants.locking_damping, 0.0
    capacity = scale * constants.capacity
    if torque > capacity:
        torque, slope, by_schedule = capacity, 0.0, constants.capacity
    elif torque < -capacity:
        torque, slope, by_schedule = -capacity, 0.0, -constants.capacity
    return LinkTorque(torque, 0.0, slope, by_schedule, 0.0, torque * rate)


class FrictionClutch(HubLink):
    """A clutch that transmits torque up to its capacity and slips above it.

    Examples
    --------
    >>> bd.FrictionClutch(kind="friction_clutch", capacity="20 N m", locking_damping=1.0).capacity
    20.0
    """

    constants = FRICTION_CLUTCH
    torque_at = friction_clutch

    kind: Literal["friction_clutch"] = Field(description="the kind of link")
    capacity: Torque = Field(gt=0, description="the largest torque, in N*m")
    locking_damping: TorsionalDamping = Field(
        gt=0, description="the torque over the slip speed below capacity, in N m s/rad"
    )
    schedule: Schedule | None = Field(None, description="the factor on the capacity over time, from 0 to 1")

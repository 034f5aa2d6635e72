"""Couplings in a hub: isolators, one-way and friction clutches.

An overrunning clutch: sense max(c x, -drag), x = sense rate.

The front body drives the back one where it is faster in the sense of driving, x > 0, with a torque c x that lets it
creep, as the friction of the belt does (Eq. 20); where it is slower the clutch overruns and only drags.
Zhu and Parker (J. Sound Vib. 279, 2005) put a stiff spring in the place of c x.
"""

from collections.abc import Mapping
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field

from beltdyn.arrays import record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.links.link import HubLink, LinkTorque
from beltdyn.machines.profiles import Schedule
from beltdyn.parts.quantity import Torque, TorsionalDamping, TorsionalStiffness

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


# A clutch that slips at its capacity: c rate between -capacity and +capacity, which a schedule multiplies

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


@register
class FrictionClutch(HubLink):
    """A clutch that transmits torque up to its capacity and slips above it.

    Examples
    --------
    >>> bd.model.FrictionClutch(
    ...     kind="friction_clutch", capacity="20 N m", locking_damping=1.0, inertia="20 kg cm^2"
    ... ).capacity
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


ONE_WAY_CLUTCH = record(
    locking_damping="f8",  # c, N m s/rad
    drag_torque="f8",  # largest torque while it overruns, N m
    sense="f8",  # +1 if the front body drives counter-clockwise, -1 if clockwise
)


@kernel
def one_way_clutch(constants: np.record, _scale: float, _twist: float, rate: float) -> LinkTorque:
    """Torque of the clutch; arguments as for `HubLink.torque_at`, constants a row of `ONE_WAY_CLUTCH`."""
    torque, slope = constants.locking_damping * constants.sense * rate, constants.locking_damping
    if torque < -constants.drag_torque:
        torque, slope = -constants.drag_torque, 0.0
    torque *= constants.sense
    return LinkTorque(torque, 0.0, slope, 0.0, 0.0, torque * rate)


@register
class OneWayClutch(HubLink):
    """An overrunning clutch, which drives the body behind it in one sense only and lets it run ahead.

    It creeps while it drives: the torque is `locking_damping` times the slip speed.

    Examples
    --------
    >>> bd.model.OneWayClutch(kind="one_way_clutch", locking_damping=1.0, inertia="20 kg cm^2").inertia
    0.002
    """

    constants = ONE_WAY_CLUTCH
    torque_at = one_way_clutch

    kind: Literal["one_way_clutch"] = Field(description="the kind of link")
    locking_damping: TorsionalDamping = Field(
        gt=0, description="the torque over the slip speed while driving, in N m s/rad"
    )
    drag_torque: Torque = Field(0.0, ge=0, description="the largest torque while overrunning, in N*m")
    drives: Literal["forward", "backward"] = Field(
        "forward",
        description="the driving sense of the rim; forward is the turning sense of the pulley by an advancing belt",
    )

    def reversed(self) -> Self:
        """As in the base, driving in the other sense."""
        return self.replace(drives="backward" if self.drives == "forward" else "forward")

    def values(self, turning: int) -> Mapping[str, Any]:
        """Its constants, with the driving sense."""
        sense = turning if self.drives == "forward" else -turning
        return {"locking_damping": self.locking_damping, "drag_torque": self.drag_torque, "sense": sense}

"""The links of a hub chain: what couples the rim of a pulley with the bodies behind it."""

from typing import Annotated, Literal

from pydantic import Field

from beltdyn.model.part import Part
from beltdyn.model.profile import Schedule
from beltdyn.model.quantity import Inertia, Torque, TorsionalDamping, TorsionalStiffness


class HubLink(Part):
    """A coupling, and the body behind it."""

    inertia: Inertia = Field(0.0, ge=0, description="the moment of inertia of the body behind the link, in kg*m^2")


class Isolator(HubLink):
    """A torsional spring and damper in parallel."""

    kind: Literal["isolator"] = Field(description="the kind of link")
    stiffness: TorsionalStiffness = Field(gt=0, description="the torque over the twist, in N*m/rad")
    damping: TorsionalDamping = Field(0.0, ge=0, description="the torque over the rate of twist, in N m s/rad")


class OneWayClutch(HubLink):
    """An overrunning clutch: it drives the body behind it in one sense only, and lets it run ahead.

    It creeps while it drives: the torque is `locking_damping` times the slip speed.
    """

    kind: Literal["one_way_clutch"] = Field(description="the kind of link")
    locking_damping: TorsionalDamping = Field(
        gt=0, description="the torque over the slip speed while it drives, in N m s/rad"
    )
    drag_torque: Torque = Field(0.0, ge=0, description="the largest torque while it overruns, in N*m")
    drives: Literal["forward", "backward"] = Field(
        "forward",
        description="the sense in which the rim drives: forward is that in which an advancing belt turns the pulley",
    )


class FrictionClutch(HubLink):
    """A clutch that transmits a torque up to its capacity, and slips beyond it."""

    kind: Literal["friction_clutch"] = Field(description="the kind of link")
    capacity: Torque = Field(gt=0, description="the largest torque, in N*m")
    locking_damping: TorsionalDamping = Field(
        gt=0, description="the torque over the slip speed below the capacity, in N m s/rad"
    )
    schedule: Schedule | None = Field(None, description="the factor on the capacity over time, from 0 to 1")


AnyHubLink = Annotated[Isolator | OneWayClutch | FrictionClutch, Field(discriminator="kind")]

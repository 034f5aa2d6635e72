"""The contract of a link of a hub chain: keys, constants, and torque with exact derivatives."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field

from beltdyn.kernel import KernelKinds
from beltdyn.machines.profiles.profile import Profile
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Inertia


class LinkTorque(NamedTuple):
    """Torque of a link on its back body, counter-clockwise, and the opposite on its front body."""

    torque: float
    """N m."""
    by_twist: float
    """N m/rad."""
    by_rate: float
    """N m s/rad."""
    by_schedule: float
    """Derivative with respect to the factor of its schedule, N m; zero where it does not act, as while a clutch
    sticks."""
    energy: float
    """Stored, J."""
    loss: float
    """Power lost, W."""


class HubLink(Part):
    """A coupling with the body behind it.

    A kind of link is a class with a field `kind`, and says as class attributes what kernels need. It may have a field
    `schedule`.
    """

    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants; by default these are the fields of the same names."""
    torque_at: ClassVar[Callable[[np.record, float, float, float], LinkTorque]]
    """Kernel: the torque from constants, the factor of its schedule (1 without), twist and its rate: angle of the front
    body less that of the back one, rad and rad/s."""

    if TYPE_CHECKING:
        kind: str

    inertia: Inertia = Field(0.0, ge=0, description="the moment of inertia of the body behind the link, in kg*m^2")

    def values(self, _turning: int) -> Mapping[str, Any]:
        """Its constants on a pulley turned counter-clockwise (1) or clockwise (-1) by the advancing belt."""
        return {name: getattr(self, name) for name in self.constants.names or ()}

    def reversed(self) -> Self:
        """The coupling in a drive that runs in the opposite sense; by default the same."""
        return self

    @property
    def factor(self) -> Profile | None:
        """Its schedule, if it has one."""
        return getattr(self, "schedule", None)


LINKS = KernelKinds[type[HubLink]]("hub coupling", HubLink)
"""All kinds of couplings by name."""

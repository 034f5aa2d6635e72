"""A displacement pump, as with gears, vanes or pistons: M = -p V / (2 pi eta), against the motion.

With a displacement V in a turn, a rise of pressure p and the hydraulic-mechanical efficiency eta.
"""

from collections.abc import Mapping
from math import tau
from typing import Annotated, Any, Literal

from pydantic import Field

from beltdyn.machines.loads.brake import BRAKE, braking_torque
from beltdyn.machines.loads.load import Load
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.profiles.registry import PressureProfile
from beltdyn.parts.quantity import AngularSpeed, Ratio, quantity


class Pump(Load):
    """A displacement pump (gear, vane or piston), whose torque follows the pressure at any speed.

    Examples
    --------
    >>> load = bd.Pump(
    ...     kind="pump", displacement="10 cm^3",
    ...     pressure={"kind": "constant", "value": 1e6}, efficiency=0.9
    ... )
    >>> load.efficiency
    0.9
    """

    constants = BRAKE
    torque_at = braking_torque

    kind: Literal["pump"] = Field(description="the kind of load")
    displacement: Annotated[float, quantity("m^3")] = Field(gt=0, description="the displaced volume per turn, in m^3")
    pressure: PressureProfile = Field(description="the pressure rise over time, in Pa")
    efficiency: Ratio = Field(gt=0, le=1, description="the hydraulic-mechanical efficiency, 0 to 1")
    creep_speed: AngularSpeed = Field(0.1, gt=0, description="the speed at which the torque reaches 76 %, in rad/s")

    def values(self) -> Mapping[str, Any]:
        """Torques over the pressure, and the creep speed."""
        arm = self.displacement / (tau * self.efficiency)
        return {"forward": arm, "backward": arm, "creep_speed": self.creep_speed}

    @property
    def command(self) -> Profile:
        """The pressure rise over time."""
        return self.pressure

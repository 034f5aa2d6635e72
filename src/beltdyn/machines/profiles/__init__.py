"""Prescribed speeds, torques and schedules over time, and harmonics over the shaft angle."""

from beltdyn.machines.profiles.moves import PositionTable as PositionTable
from beltdyn.machines.profiles.moves import SCurve as SCurve
from beltdyn.machines.profiles.moves import Trapezoid as Trapezoid
from beltdyn.machines.profiles.ramps import (
    Constant as Constant,
)
from beltdyn.machines.profiles.ramps import (
    CosineRamp as CosineRamp,
)
from beltdyn.machines.profiles.ramps import (
    CosineRampPublished as CosineRampPublished,
)
from beltdyn.machines.profiles.ramps import (
    Ramp as Ramp,
)
from beltdyn.machines.profiles.ramps import (
    Step as Step,
)
from beltdyn.machines.profiles.ramps import Table as Table

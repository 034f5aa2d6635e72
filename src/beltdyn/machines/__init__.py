"""The machines around a belt: loads and motors, hub chains, tensioners, prescribed functions of time.

A kind of machine is a file: the class that a user's keys make, a record of its constants, and kernels that give its
force with exact derivatives.  The `__init__` of a family imports its kinds, one a line, and makes from them the field
type of drive files, the rows of tables and the kernels that evaluate any of them.
"""

from beltdyn.machines.carrying import Goods, Guide, Idlers
from beltdyn.machines.carrying.support import Support
from beltdyn.machines.links import FrictionClutch, Isolator, OneWayClutch
from beltdyn.machines.links.link import HubLink
from beltdyn.machines.loads import (
    AngleSpeedTable,
    AngleTable,
    BandBrake,
    Brake,
    Fan,
    FunctionLoad,
    Generator,
    Holdback,
    InductionMotor,
    LoadTable,
    Motor,
    PowerTable,
    Pump,
    Resistance,
    ServoMotor,
    SpeedTrim,
    TorqueTrim,
)
from beltdyn.machines.loads.load import Load
from beltdyn.machines.profiles import (
    Constant,
    CosineRamp,
    CosineRampPublished,
    PositionTable,
    Ramp,
    SCurve,
    Step,
    Table,
    Trapezoid,
)
from beltdyn.machines.profiles.harmonic import Harmonic
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.tensioners import FixedTensioner, RotaryTensioner, SlidingTensioner
from beltdyn.machines.tensioners.tensioner import MovingTensioner, Tensioner

__all__ = [
    "AngleSpeedTable",
    "AngleTable",
    "BandBrake",
    "Brake",
    "Constant",
    "CosineRamp",
    "CosineRampPublished",
    "Fan",
    "FixedTensioner",
    "FrictionClutch",
    "FunctionLoad",
    "Generator",
    "Goods",
    "Guide",
    "Harmonic",
    "Holdback",
    "HubLink",
    "Idlers",
    "InductionMotor",
    "Isolator",
    "Load",
    "LoadTable",
    "Motor",
    "MovingTensioner",
    "OneWayClutch",
    "PositionTable",
    "PowerTable",
    "Profile",
    "Pump",
    "Ramp",
    "Resistance",
    "RotaryTensioner",
    "SCurve",
    "ServoMotor",
    "SlidingTensioner",
    "SpeedTrim",
    "Step",
    "Support",
    "Table",
    "Tensioner",
    "TorqueTrim",
    "Trapezoid",
]

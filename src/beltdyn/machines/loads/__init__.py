"""Loads and motors on the shaft of a pulley: torques over its speed and angle, switched over time."""

from beltdyn.machines.loads.brake import BandBrake as BandBrake
from beltdyn.machines.loads.brake import Brake as Brake
from beltdyn.machines.loads.brake import Holdback as Holdback
from beltdyn.machines.loads.function import FunctionLoad as FunctionLoad
from beltdyn.machines.loads.induction_motor import InductionMotor as InductionMotor
from beltdyn.machines.loads.motor import Generator as Generator
from beltdyn.machines.loads.motor import Motor as Motor
from beltdyn.machines.loads.motor import ServoMotor as ServoMotor
from beltdyn.machines.loads.resistance import Fan as Fan
from beltdyn.machines.loads.resistance import Pump as Pump
from beltdyn.machines.loads.resistance import Resistance as Resistance
from beltdyn.machines.loads.table import (
    AngleSpeedTable as AngleSpeedTable,
)
from beltdyn.machines.loads.table import (
    AngleTable as AngleTable,
)
from beltdyn.machines.loads.table import (
    LoadTable as LoadTable,
)
from beltdyn.machines.loads.table import (
    PowerTable as PowerTable,
)
from beltdyn.machines.loads.trim import SpeedTrim as SpeedTrim
from beltdyn.machines.loads.trim import TorqueTrim as TorqueTrim

"""Loads and motors on the shaft of a pulley: torques over its speed and angle, switched over time."""

from typing import Annotated

from beltdyn.kernel import KindRows, choice
from beltdyn.machines.loads.brake import BandBrake as BandBrake
from beltdyn.machines.loads.brake import Brake as Brake
from beltdyn.machines.loads.brake import Holdback as Holdback
from beltdyn.machines.loads.function import FunctionLoad as FunctionLoad
from beltdyn.machines.loads.induction_motor import InductionMotor as InductionMotor
from beltdyn.machines.loads.load import LOADS, Load
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
from beltdyn.parts.kind_fields import OneOf

AnyLoad = Annotated[Load, OneOf(LOADS)]

NO_STATE = -1
"""Place of the state of a load without one."""

SHAFT_LOADS = KindRows(
    LOADS,
    lambda kind: kind.constants,
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
    command="i8",  # number of the profile whose value it gets, or `NO_SCHEDULE`
    state="i8",  # place of its controller's state among the bodies, or `NO_STATE`
    number="i8",  # place of its first number; the last is that before the first of the next row
    harmonic="i8",  # its first harmonic over the shaft angle, alike
    sensor="i8",  # coordinate of its sensor, counted from the last one on, from 1; 0 without
    sensor_rate="f8",  # error of the sensor over that coordinate
    sensor_zero="f8",  # error at its zero
    order="f8",  # the highest order over the shaft angle
)
"""Rows of loads on shafts, with the constants of their kinds; those of others are zero."""
SHAFT_LOAD = SHAFT_LOADS.row_type()
"""The row of a load of the package."""

torque_of_kind = choice("torque_of_kind", LOADS.functions("torque_at"), ["numbers", "shaft"])
rate_of_kind = choice("rate_of_kind", LOADS.functions("rate_at"), ["numbers", "shaft"])
slope_of_kind = choice("slope_of_kind", LOADS.functions("slope_at"), ["numbers", "shaft"])
kink_of_kind = choice("kink_of_kind", LOADS.functions("next_kink"), ["numbers", "shaft", "rising"])

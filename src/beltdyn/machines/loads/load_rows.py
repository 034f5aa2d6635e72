"""Loads of any kind: their field type, and the kernels that evaluate them."""

from typing import Annotated

import beltdyn.machines.loads  # noqa: F401  whose kinds register themselves
from beltdyn.kernel import KindRows, choice
from beltdyn.machines.loads.load import LOADS, Load
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

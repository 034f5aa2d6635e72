"""Loads of any kind: their field type, and the kernels that evaluate them."""

from typing import TYPE_CHECKING

from beltdyn.kernel import choice
from beltdyn.machines import loads as kinds
from beltdyn.machines.family import any_of, constants_of, kinds_in
from beltdyn.machines.loads.load import Load
from beltdyn.records import record

KINDS = kinds_in(kinds)

if TYPE_CHECKING:
    AnyLoad = Load
else:
    AnyLoad = any_of(KINDS)

NO_STATE = -1
"""Place of the state of a load without one."""

SHAFT_LOAD = record(
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
    command="i8",  # number of the profile whose value it gets, or `NO_SCHEDULE`
    state="i8",  # place of its controller's state among the bodies, or `NO_STATE`
    number="i8",  # place of its first number; the last is that before the first of the next row
    harmonic="i8",  # its first harmonic over the shaft angle, alike
    order="f8",  # the highest order over the shaft angle
    kind="i8",  # place among `KINDS`
    **constants_of(KINDS),
)
"""A load on a shaft, with the constants of its kind; those of the others are zero."""

torque_of_kind = choice("torque_of_kind", {k: v.torque_at for k, v in KINDS.items()}, ["numbers", "shaft"])
rate_of_kind = choice("rate_of_kind", {k: v.rate_at for k, v in KINDS.items()}, ["numbers", "shaft"])
kink_of_kind = choice("kink_of_kind", {k: v.next_kink for k, v in KINDS.items()}, ["numbers", "shaft", "rising"])

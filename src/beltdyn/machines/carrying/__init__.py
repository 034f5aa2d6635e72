"""What carries a belt between its pulleys, and the goods that it carries."""

from typing import Annotated

from beltdyn.arrays import record
from beltdyn.kernel import KindRows, choice
from beltdyn.machines.carrying.support import SUPPORTS, Support
from beltdyn.machines.carrying.support import Goods as Goods
from beltdyn.machines.carrying.support import Guide as Guide
from beltdyn.machines.carrying.support import Idlers as Idlers
from beltdyn.parts.kind_fields import OneOf

AnySupport = Annotated[Support, OneOf(SUPPORTS)]

LINE = record(
    origin="2f8",  # start of the span, m
    direction="2f8",  # unit vector along the span
    first="f8",  # where it begins along the span, m
    last="f8",  # where it ends, m
)
"""A stretch of a span."""

SUPPORT_ROWS = KindRows(
    SUPPORTS,
    lambda kind: kind.constants,
    line=LINE,
    normal="2f8",  # unit vector to the side on which the belt lies
    curvature="f8",  # of the line towards that side, 1/m
    raised="f8",  # how far it stands above the span, so that the belt without goods lies straight, m
    stiffness="f8",  # N/m^2
    damping="f8",  # N s/m^2
    both_sides="i8",  # whether the support also holds the belt down
    rotating="f8",  # mass that moves with the belt along the span, kg/m
    resisting="f8",  # factor on the resistance
)
"""Rows of supports, with the constants of their kinds; those of others are zero."""
SUPPORT = SUPPORT_ROWS.row_type()
"""The row of a support of the package."""

GOODS = record(
    line=LINE,
    mass="f8",  # kg/m
    rear="f8",  # of a batch, along the span when no belt has passed, m; -inf of goods that lie everywhere
    front="f8",
    stretch="f8",  # way of goods over the length of unstretched belt that has passed
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
)
"""Goods on a span."""

resistance_of_kind = choice("resistance_of_kind", SUPPORTS.functions("resistance_at"), ["normal", "speed"])

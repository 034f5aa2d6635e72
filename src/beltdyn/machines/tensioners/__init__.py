"""Tensioners, which press a pulley against the belt."""

from typing import Annotated

import numpy as np

from beltdyn.arrays import FloatArray, row
from beltdyn.kernel import KindRows, choice, kernel
from beltdyn.machines.tensioners.rotary import RotaryTensioner as RotaryTensioner
from beltdyn.machines.tensioners.sliding import SlidingTensioner as SlidingTensioner
from beltdyn.machines.tensioners.tensioner import TENSIONERS, MovingTensioner, Tensioner
from beltdyn.machines.tensioners.tensioner import FixedTensioner as FixedTensioner
from beltdyn.machines.tensioners.tensioner import SpringTensioner as SpringTensioner
from beltdyn.parts.kind_fields import OneOf

AnyTensioner = Annotated[Tensioner, OneOf(TENSIONERS)]


def _moves(kind: type[Tensioner]) -> bool:
    return issubclass(kind, MovingTensioner)


TENSIONER_ROWS = KindRows(
    TENSIONERS,
    lambda kind: kind.constants if _moves(kind) else None,
    pulley="i8",  # the pulley that it carries
    weight="2f8",  # force of gravity on tensioner and pulley, as if at the center of the pulley, N
    push="f8",  # constant force on its coordinate from outside, N or N m
)
"""Rows of spring-loaded tensioners with the constants of their kinds; those of others are zero."""
TENSIONER = TENSIONER_ROWS.row_type()
"""The row of a tensioner of the package."""

tensioner_center = choice("tensioner_center", TENSIONERS.functions("center_at", _moves), ["q"])
tensioner_force = choice("tensioner_force", TENSIONERS.functions("force_at", _moves), ["q", "velocity"])


@kernel
def fill_forces(tensioner: np.record, positions: FloatArray, forces: FloatArray) -> None:
    """Overwrite forces, N or N m, with those of spring and stops at rest; `tensioner`: a row; positions in m or rad."""
    for number in range(positions.size):
        forces[number] = tensioner_force(tensioner, positions[number], 0.0).force


def tensioner_row(tensioner: MovingTensioner, pulley: int, center: FloatArray, gradient: FloatArray) -> np.record:
    """Row of a tensioner without weight; ValueError if it cannot tension the belt."""
    made = row(TENSIONER_ROWS.row_type([type(tensioner)]), pulley=pulley)
    TENSIONER_ROWS.fill(made, type(tensioner), tensioner.values(center, gradient))
    return made


def free_slide(row_type: np.dtype[np.void], pulley: int, center: tuple[float, float]) -> np.record:
    """Row of a type for a carrier that slides along a line without spring, friction and stops."""
    made = row(row_type, pulley=pulley)
    spring = {"creep_speed": 1.0, "lower": -np.inf, "upper": np.inf}
    values = {"center": center, "direction": (1.0, 0.0), "spring": spring}
    TENSIONER_ROWS.fill(made, TENSIONERS["sliding"], values)
    return made

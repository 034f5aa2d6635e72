"""Tensioners of any kind: their field type, their rows, and the kernels that evaluate them."""

from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import choice
from beltdyn.machines import tensioners as kinds
from beltdyn.machines.family import any_of, constants_of, kinds_in
from beltdyn.machines.tensioners.tensioner import MovingTensioner, Tensioner
from beltdyn.records import fill, record, row

KINDS = kinds_in(kinds)

if TYPE_CHECKING:
    AnyTensioner = Tensioner
else:
    AnyTensioner = any_of(KINDS)

_MOVING = {name: kind for name, kind in KINDS.items() if issubclass(kind, MovingTensioner)}

TENSIONER = record(
    pulley="i8",  # the pulley that it carries
    weight="2f8",  # force of gravity on tensioner and pulley, as if at the center of the pulley, N
    push="f8",  # constant force on its coordinate from outside, N or N m
    kind="i8",  # place among the kinds that move
    **constants_of(_MOVING),
)
"""A spring-loaded tensioner with the constants of its kind; those of other kinds are zero."""

tensioner_center = choice("tensioner_center", {k: v.center_at for k, v in _MOVING.items()}, ["q"])
tensioner_force = choice("tensioner_force", {k: v.force_at for k, v in _MOVING.items()}, ["q", "velocity"])


def tensioner_row(tensioner: MovingTensioner, pulley: int, center: FloatArray, gradient: FloatArray) -> np.record:
    """Row of `TENSIONER` of a tensioner, without weight.

    Parameters
    ----------
    tensioner
        The tensioner.
    pulley
        Number of the pulley that it carries.
    center, gradient : ndarray, shape (2,)
        As for `MovingTensioner.leverage`.

    Raises
    ------
    ValueError
        If it cannot tension the belt.
    """
    made = row(TENSIONER, pulley=pulley, kind=list(_MOVING).index(tensioner.kind))
    fill(made[tensioner.kind], tensioner.values(center, gradient))
    return made


def free_slide(pulley: int, center: tuple[float, float]) -> np.record:
    """Row of `TENSIONER` of a carrier that slides along a line without spring, friction and stops."""
    made = row(TENSIONER, pulley=pulley, kind=list(_MOVING).index("sliding"))
    spring = {"creep_speed": 1.0, "lower": -np.inf, "upper": np.inf}
    fill(made["sliding"], {"center": center, "direction": (1.0, 0.0), "spring": spring})
    return made

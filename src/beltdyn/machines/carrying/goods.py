"""Goods that a belt carries along a span."""

from typing import Self

from pydantic import Field, model_validator

from beltdyn.machines.carrying.support import OnSpan
from beltdyn.machines.profiles.profile_types import Schedule
from beltdyn.parts.quantity import Coordinate, MassPerLength


class Goods(OnSpan):
    """Goods that ride on a span: they get on with the belt's speed, have weight, and are accelerated with it.

    They lie from `start` to `end`, or, as a batch, move with the belt from `start`, where they get on, to `end`.

    Examples
    --------
    >>> bd.model.Goods(span=["tail", "head"], mass_per_length="110 kg/m").mass_per_length
    110.0
    """

    mass_per_length: MassPerLength = Field(gt=0, description="the mass of the goods over the length, in kg/m")
    schedule: Schedule | None = Field(None, description="the factor on the mass over time, from 0 to 1")
    batch: tuple[Coordinate, Coordinate] | None = Field(
        None,
        description="the rear and the front, at time zero, of a batch that moves with the belt, from the start of the "
        "span, in m; by default goods lie everywhere",
    )

    @model_validator(mode="after")
    def _has_a_front(self) -> Self:
        if self.batch is not None and not self.batch[0] < self.batch[1]:
            raise ValueError(
                f"batch = [{self.batch[0]:g}, {self.batch[1]:g}] m must be the rear and the front of the batch, in the "
                "running order of the belt. Exchange them"
            )
        return self

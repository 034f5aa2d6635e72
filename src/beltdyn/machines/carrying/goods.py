"""Goods that a belt carries along a span."""

from pydantic import Field

from beltdyn.machines.carrying.support import OnSpan
from beltdyn.machines.profiles.registry import Schedule
from beltdyn.parts.quantity import MassPerLength


class Goods(OnSpan):
    """Goods that ride on a span: they get on with the belt's speed, have weight, and are accelerated with it.

    Examples
    --------
    >>> bd.model.Goods(span=["tail", "head"], mass_per_length="110 kg/m").mass_per_length
    110.0
    """

    mass_per_length: MassPerLength = Field(gt=0, description="the mass of the goods over the length, in kg/m")
    schedule: Schedule | None = Field(None, description="the factor on the mass over time, from 0 to 1")

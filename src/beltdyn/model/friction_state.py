"""Friction of rubber on metal by the state of its surfaces: dry, wet, glazed."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, NamedTuple

from beltdyn.parts.quantity import quantity


class FrictionState(NamedTuple):
    """Friction of rubber on smooth metal, without the wedge effect."""

    friction: float
    """Coefficient of friction, before it falls with the slip velocity."""
    least: float
    """Least coefficient that is published, or estimated."""
    largest: float
    """Largest one."""
    kinetic_ratio: float
    """Kinetic over static friction; 1 where friction does not fall with the slip velocity."""
    stribeck_velocity: float
    """Slip velocity over which the difference falls to 1/e, m/s."""
    source: str
    """What is published, and what is an estimate."""


FRICTION_STATES: Mapping[str, FrictionState] = MappingProxyType(
    {
        "dry": FrictionState(
            *(0.35, 0.30, 0.45, 1.0, 0.5),
            "0.35 to 0.40 on bare steel, 0.40 to 0.45 on rubber (ISO 5048:1989); 0.31 to 0.33 published for grooves",
        ),
        "wet": FrictionState(
            *(0.20, 0.10, 0.35, 0.7, 0.5),
            "0.10 on bare steel, 0.35 on rubber (ISO 5048:1989); friction that falls with the slip velocity and makes "
            "noise (Sheng et al. 2007); static at least 1.4 times kinetic, and kinetic 30 to 40 % below that of dry "
            "V-ribbed belts (Sheng et al. 2011); the slip velocity of the fall is an estimate",
        ),
        "glazed": FrictionState(*(0.20, 0.15, 0.25, 0.8, 0.5), "estimates: about half of dry, falling by a fifth"),
    }
)
"""Name of a state -> its friction."""

Friction = Annotated[float, quantity("", words={name: one.friction for name, one in FRICTION_STATES.items()})]
"""A coefficient of friction, or the name of a state."""

IN_WORDS = ", ".join(f'"{name}" ({one.friction:g})' for name, one in FRICTION_STATES.items())
"""States with their coefficients, for the descriptions of keys."""

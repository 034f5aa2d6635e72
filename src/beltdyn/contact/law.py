"""Constants of the contact between belt and pulleys, and the state of one pulley as contact sees it."""

from typing import Final, NamedTuple

FORCE_SLOPE: Final = 0
"""Friction law of the paper: the friction force grows with slope nu_s until the Coulomb limit (Fig. 3)."""

COEFFICIENT_SLOPE: Final = 1
"""Friction law of Leamy and Wasfy: the friction coefficient grows linearly up to a creep velocity."""


class ContactLaw(NamedTuple):
    """Penalty and friction constants."""

    stiffness: float
    """k_p, N/m per m of belt, that is N/m^2."""
    damping: float
    """c_p, N s/m per m of belt."""
    friction: float
    """Coulomb coefficient mu."""
    friction_law: int
    """`FORCE_SLOPE` or `COEFFICIENT_SLOPE`."""
    creep: float
    """nu_s in kg/(m s) for `FORCE_SLOPE`, the creep velocity in m/s for `COEFFICIENT_SLOPE`."""
    may_pull: bool
    """Whether f_n may become negative, as Eq. 17 is printed."""
    follow_zone: bool
    """Integrate over the touching part of an element only; False is the published rule, over the whole element."""
    arm_to_rim: bool = False
    """Whether friction turns the pulley with the arm R; False is the published rule, R - d."""


class Wheel(NamedTuple):
    """A pulley at one instant, as the belt meets it."""

    center_x: float
    """m."""
    center_y: float
    """m."""
    radius: float
    """R, m."""
    speed: float
    """Angular speed omega, rad/s, counter-clockwise positive."""
    velocity_x: float = 0.0
    """Velocity of its centre, m/s."""
    velocity_y: float = 0.0

"""Constants of the contact between belt and pulleys, and the state of one pulley as contact sees it."""

from typing import NamedTuple


class ContactLaw(NamedTuple):
    """Penalty and friction constants."""

    stiffness: float
    """k_p, N/m per m of belt, that is N/m^2."""
    damping: float
    """c_p, N s/m per m of belt."""
    friction: float
    """Coulomb coefficient mu."""
    friction_law: int
    """Number of the friction law in `beltdyn.contact.friction.LAWS`."""
    creep: float
    """Parameter of the friction law: nu_s in kg/(m s), or the creep velocity in m/s."""
    may_pull: bool
    """Whether f_n may become negative, as Eq. 17 is printed."""
    follow_zone: bool
    """Integrate over the touching part of an element only; False is the published rule, over the whole element."""
    arm_to_rim: bool = False
    """Whether friction turns the pulley with the arm R; False is the published rule, R - d."""


class PulleyState(NamedTuple):
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

"""The contact laws of belt and pulleys, and the state of a pulley as contact sees it."""

from typing import NamedTuple

from beltdyn.contact.friction import FrictionParameters
from beltdyn.contact.normal import NormalParameters
from beltdyn.contact.surface import Polygon, Round, Shaped, Toothed


class ContactLaw(NamedTuple):
    """Laws of normal force and friction with their parameters, and how contact is integrated."""

    normal: NormalParameters
    """Parameters of the law of the normal force; their type identifies the law."""
    friction: FrictionParameters
    """Parameters of the friction law, `CommonFriction` of one of the package; another type identifies its law."""
    follow_zone: bool
    """Integrate over the contact zone of an element only; False is the published rule, over the whole element."""
    arm_to_rim: bool = False
    """Whether the moment arm of friction is that of slip; False is the published rule, R - d."""


class PulleyState(NamedTuple):
    """A pulley at one instant, as the belt meets it."""

    center_x: float
    """Place of its shaft, m."""
    center_y: float
    surface: Round | Shaped | Toothed | Polygon
    """Its surface, at the angle that it has."""
    speed: float
    """Angular speed omega, rad/s, counter-clockwise positive."""
    friction: float
    """Coulomb coefficient mu."""
    velocity_x: float = 0.0
    """Velocity of its shaft, m/s."""
    velocity_y: float = 0.0
    rolling: float = 0.0
    """Coefficient rho of rolling resistance."""
    foundation: float = 1.0
    """Factor on the law of the normal force, below 1 with an elastic cover."""
    damping: float = 1.0
    """Damping over stiffness of contact against that of the law."""
    rim_ratio: float = 1.0
    """Radius at which the tension line rolls off over that of the surface."""
    cord: float = 0.0
    """Whether slip is taken at the radius of the cord, which sinks into the belt's rubber: 1, else 0."""
    hertz: float = 0.0
    """Penetration of a solid roller over the square of its line force, 2 R / (b E*)^2, m^3/N^2."""
    lasting: float = 0.0
    """By how much the belt stays compressed where it leaves, m."""
    unloading: float = 1.0
    """Stiffness where it leaves over that where it is pressed."""

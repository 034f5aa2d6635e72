"""Moment of the contact forces on the pulley (Eq. 23)."""

from beltdyn.contact.penetration import Approach
from beltdyn.kernel import kernel


@kernel
def pulley_moment(point: Approach, friction: float) -> float:
    """Moment per length about the pulley's centre, -(R - d) f_t (Eq. 23); R - d is the distance of the point.

    Parameters
    ----------
    point
        The belt point.
    friction
        Friction force f_t on the belt along t, N/m.

    Returns
    -------
    float
        N m per m of reference length, counter-clockwise positive.
    """
    return -point.distance * friction

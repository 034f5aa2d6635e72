"""Moment of the contact forces on the pulley (Eq. 23)."""

from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.penetration import Approach
from beltdyn.kernel import kernel


@kernel
def moment_arm(point: Approach, pulley: PulleyState, law: ContactLaw) -> tuple[float, float]:
    """Arm of friction about the pulley's centre, m, and its change with the distance of the point.

    The arm is R - d as published (Eq. 23), the distance of the point; or R, with which slip is taken (Eq. 22), so that
    friction can only lose energy: f_t v_t in place of f_t (v_t + omega d).
    """
    return (pulley.radius, 0.0) if law.arm_to_rim else (point.distance, 1.0)


@kernel
def pulley_moment(arm: float, friction: float) -> float:
    """Moment per length about the pulley's centre, -arm f_t (Eq. 23).

    Parameters
    ----------
    arm
        m.
    friction
        Friction force f_t on the belt along t, N/m.

    Returns
    -------
    float
        N m per m of reference length, counter-clockwise positive.
    """
    return -arm * friction

"""Moment of the contact forces on the pulley (Eq. 23)."""

from beltdyn.contact.law import ContactLaw
from beltdyn.contact.penetration import Approach
from beltdyn.kernel import kernel


@kernel
def moment_arm(point: Approach, law: ContactLaw) -> tuple[float, float]:
    """Arm of friction about the pulley's shaft, m, and its change with the distance of the point.

    On a smooth circle the arm is R - d as published (Eq. 23), the distance of the point; or R, with which slip is taken
    (Eq. 22), so that friction can only lose energy: f_t v_t in place of f_t (v_t + omega d).
    """
    return (point.rim, 0.0) if law.arm_to_rim else (point.lever, 1.0)


@kernel
def pulley_moment(normal: float, friction: float, offset: float, arm: float) -> float:
    """Moment per length about the pulley's shaft, f_n (p . t) - arm f_t (Eq. 23).

    Parameters
    ----------
    normal
        Normal force f_n on the belt along n, N/m.
    friction
        Friction force f_t on the belt along t, N/m.
    offset
        Arm p . t of the normal force, m; zero on a smooth circle.
    arm
        Arm of friction, m.

    Returns
    -------
    float
        N m per m of reference length, counter-clockwise positive.
    """
    return normal * offset - arm * friction

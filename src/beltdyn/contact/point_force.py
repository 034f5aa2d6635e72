"""Contact force at one point of the belt and its variation (Eqs. 17-22).

With n, t of Eqs. 19 and 21, subscripts n, t for components along them, v the velocity of the point and rho its
distance from the pulley's centre, a change of position, velocity and pulley speed changes

    d by -dr_n,   dd/dt by -v_t dr_t / rho - dv_n,   n by t dr_t / rho,   t by -n dr_t / rho,
    the slip velocity by -v_n dr_t / rho + dv_t - R d(omega),

from which the variations of f_n n + f_t t and of the moment -rho f_t, or -R f_t, follow.
"""

from typing import NamedTuple

from beltdyn.contact.friction import friction_force
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import NormalForce, normal_force
from beltdyn.contact.penetration import Approach, slip_velocity
from beltdyn.contact.pulley_moment import moment_arm
from beltdyn.kernel import kernel


class PointForce(NamedTuple):
    """Contact force at a point, N per m of reference length, and the slopes of its laws."""

    normal: NormalForce
    """f_n along n (Eq. 17)."""
    friction: float
    """f_t along t (Eq. 20)."""
    x: float
    """The force f_n n + f_t t on the belt."""
    y: float
    by_slip: float
    """df_t / d(slip velocity), N s/m^2."""
    by_normal: float
    """df_t / df_n."""
    arm: float
    """Arm of friction about the pulley's centre, m."""
    arm_slope: float
    """Its change with the distance of the point."""


class PointTangent(NamedTuple):
    """Variation of the force and of the moment with the position of the point, in the global frame."""

    xx: float
    xy: float
    yx: float
    yy: float
    moment_x: float
    moment_y: float


@kernel
def point_force(here: Approach, pulley: PulleyState, law: ContactLaw) -> PointForce:
    """Contact force at a point.

    Parameters
    ----------
    here
        How the point stands and moves against the pulley.
    pulley
        The pulley.
    law
        Laws of contact.
    """
    normal = normal_force(law.normal, here.penetration, -here.radial)
    slip = slip_velocity(here, pulley)
    friction, by_slip, by_normal = friction_force(law.friction, slip, normal.force, pulley.friction)
    arm, arm_slope = moment_arm(here, pulley, law)
    return PointForce(
        normal,
        friction,
        normal.force * here.normal_x - friction * here.normal_y,
        normal.force * here.normal_y + friction * here.normal_x,
        by_slip,
        by_normal,
        arm,
        arm_slope,
    )


@kernel
def point_tangent(here: Approach, force: PointForce, by_position: float, by_velocity: float) -> PointTangent:
    """Derivative of force and moment: by_position d/d(position) + by_velocity d/d(velocity).

    Parameters
    ----------
    here
        How the point stands and moves.
    force
        Result of `point_force`.
    by_position, by_velocity
        Factors of the two derivatives.
    """
    curvature = 1.0 / here.distance
    sink = -(by_position * force.normal.by_penetration + by_velocity * force.normal.by_rate)
    sweep = -by_position * force.normal.by_rate * here.circumferential * curvature
    drag = by_velocity - by_position * here.radial * curvature
    friction_n = force.by_normal * sink
    friction_t = force.by_normal * sweep + force.by_slip * drag
    nn, nt = sink, sweep - by_position * force.friction * curvature
    tn, tt = friction_n, friction_t + by_position * force.normal.force * curvature
    moment_n = -by_position * force.arm_slope * force.friction - force.arm * friction_n
    moment_t = -force.arm * friction_t
    nx, ny = here.normal_x, here.normal_y
    xn, xt, yn, yt = nx * nn - ny * tn, nx * nt - ny * tt, ny * nn + nx * tn, ny * nt + nx * tt
    return PointTangent(
        xn * nx - xt * ny,
        xn * ny + xt * nx,
        yn * nx - yt * ny,
        yn * ny + yt * nx,
        moment_n * nx - moment_t * ny,
        moment_n * ny + moment_t * nx,
    )

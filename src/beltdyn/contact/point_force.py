"""Contact force at one point of the belt and its variation (Eqs. 17-22).

Subscripts n, t mark components along them, v the velocity of the point, p its place against the shaft, w = v_n + omega
p_t its velocity along n against the surface, kappa the curvature there and a(d) = p_n + d the arm of the rim.  Changes
of position, velocity, angle theta and speed turn the normal by

    db = kappa dr_t + (1 - kappa p_n) d(theta),

and change n by t db, t by -n db, p_n by dr_n + p_t db, p_t by dr_t - p_n db, and

    d by -dr_n - p_t d(theta),
    w by dv_n + v_t db + omega (dr_t - p_n db) + p_t d(omega),
    the slip velocity by dv_t - w db + omega p_t d(theta) - a d(omega), and the speed of the rim by R d(omega),
    with slip at the cord, where a = p_n, also by -omega (dr_n + p_t d(theta)),

from which the variations of f_n n + (f_t + f_r) t and of the moment f_n p_t - arm f_t follow.  Rolling resistance f_r
goes by the velocity v_t against the shaft, which changes by dv_t - v_n db.  On a smooth circle kappa p_n = 1 and
p_t = 0.
"""

from math import sqrt
from typing import Final, NamedTuple

from beltdyn.contact.friction import friction_force
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import NormalForce, normal_force
from beltdyn.contact.penetration import Approach, slip_velocity
from beltdyn.kernel import kernel

# Moment of the contact forces on the pulley (Eq. 23)


@kernel
def moment_arm(point: Approach, law: ContactLaw) -> tuple[float, float]:
    """Arm of friction about the pulley's shaft, m, and its change with the distance of the point.

    On a smooth circle the arm is R - d as published (Eq. 23), the distance of the point; or that with which slip is
    taken (Eq. 22), so that friction can only lose energy: f_t v_t in place of f_t (v_t + omega d).
    """
    return (point.rim, point.sinking) if law.arm_to_rim else (point.lever, 1.0)


@kernel
def pulley_moment(normal: float, friction: float, offset: float, arm: float) -> float:
    """Moment per length about the pulley's shaft, f_n (p . t) - arm f_t (Eq. 23).

    `normal`: normal force f_n on the belt along n, N/m; `friction`: friction force f_t on the belt along t, N/m;
    `offset`: arm p . t of the normal force, m; zero on a smooth circle; `arm`: arm of friction, m. Returns N m per m of
    reference length, counter-clockwise positive.
    """
    return normal * offset - arm * friction


# Rolling resistance: the compression loss of the belt on a pulley, distributed over the arc

CREEPING: Final = 0.01
"""v_0: belt speed below which rolling resistance vanishes smoothly, m/s."""


class RollingResistance(NamedTuple):
    """Rolling resistance at a point and its derivatives."""

    force: float
    """f_r on the belt along t, N/m."""
    by_normal: float
    """df_r / df_n."""
    by_velocity: float
    """df_r / dv_t, N s/m^2."""


@kernel
def rolling_resistance(coefficient: float, normal: float, velocity: float) -> RollingResistance:
    """Rolling resistance at a point of the belt.

    `coefficient`: rho, of the pulley; 0 for none; `normal`: normal force f_n, N/m; where it pulls there is none;
    `velocity`: v_t, circumferential velocity of the point against the shaft, m/s.
    """
    if coefficient == 0.0 or normal <= 0.0:
        return RollingResistance(0.0, 0.0, 0.0)
    root = sqrt(velocity * velocity + CREEPING * CREEPING)
    share = -coefficient * velocity / root
    fading = CREEPING / root
    return RollingResistance(share * normal, share, -coefficient * normal / root * fading * fading)


class PointForce(NamedTuple):
    """Contact force at a point, N per m of reference length, and the slopes of its laws."""

    normal: NormalForce
    """f_n along n (Eq. 17)."""
    friction: float
    """f_t along t (Eq. 20)."""
    rolling: RollingResistance
    """f_r along t."""
    x: float
    """The force f_n n + (f_t + f_r) t on the belt."""
    y: float
    by_slip: float
    """df_t / d(slip velocity), N s/m^2."""
    by_normal: float
    """df_t / df_n."""
    by_speed: float
    """df_t / d(omega) at a constant slip velocity, N s/m."""
    moment: float
    """Moment on the pulley, N."""
    arm: float
    """Arm of friction about the pulley's shaft, m."""
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


class PointTurn(NamedTuple):
    """Variation of the force and of the moment with the angle of the pulley."""

    x: float
    y: float
    moment: float


NO_FORCE: Final = PointForce(
    NormalForce(0.0, 0.0, 0.0, 0.0, 0.0), 0.0, RollingResistance(0.0, 0.0, 0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
)
NO_TANGENT: Final = PointTangent(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
NO_TURN: Final = PointTurn(0.0, 0.0, 0.0)


@kernel
def point_force(here: Approach, pulley: PulleyState, law: ContactLaw, secant: bool = False) -> PointForce:
    """Contact force at a point.

    `here`: how the point stands and moves against the pulley; `law`: laws of contact; `secant`: whether `by_slip` is
    the secant of friction from no slip, in place of its slope.
    """
    normal = _pressed(here, pulley, law, 0.0, 1.0)
    if pulley.lasting > 0.0 and here.radial > 0.0:
        leaving = _pressed(here, pulley, law, pulley.lasting, pulley.unloading)
        if leaving.force < normal.force:
            normal = NormalForce(leaving.force, leaving.by_penetration, leaving.by_rate, normal.elastic, normal.energy)
    slip = slip_velocity(here, pulley)
    radius = pulley.surface.radius
    friction, by_slip, by_normal, by_rim = friction_force(
        law.friction, slip, normal.force, pulley.friction, pulley.speed * radius
    )
    if secant and slip != 0.0:
        by_slip = friction / slip
    rolling = rolling_resistance(pulley.rolling, normal.force, here.circumferential)
    along = friction + rolling.force
    arm, arm_slope = moment_arm(here, law)
    return PointForce(
        normal,
        friction,
        rolling,
        normal.force * here.normal_x - along * here.normal_y,
        normal.force * here.normal_y + along * here.normal_x,
        by_slip,
        by_normal,
        by_rim * radius,
        pulley_moment(normal.force, friction, here.offset, arm),
        arm,
        arm_slope,
    )


@kernel(inline=True)
def _pressed(here: Approach, pulley: PulleyState, law: ContactLaw, lasting: float, unloading: float) -> NormalForce:
    """Normal force of a belt that is thinner by what lasts of its compression, with a stiffness times a factor."""
    factor = pulley.foundation * unloading
    normal = normal_force(law.normal, here.penetration - lasting, -here.radial * pulley.damping)
    normal = _on_cover(normal, factor, pulley.damping)
    return _on_solid(normal, factor * law.normal.stiffness, pulley.hertz)


@kernel(inline=True)
def _on_cover(normal: NormalForce, factor: float, damping: float) -> NormalForce:
    """A normal force on a foundation that is softer by a factor, with the rate times another one."""
    if factor == 1.0 and damping == 1.0:
        return normal
    return NormalForce(
        factor * normal.force,
        factor * normal.by_penetration,
        factor * damping * normal.by_rate,
        factor * normal.elastic,
        factor * normal.energy,
    )


@kernel(inline=True)
def _on_solid(normal: NormalForce, stiffness: float, hertz: float) -> NormalForce:
    """A normal force in series with solid rollers, which give way by hertz f^2 (see `theory.nip`)."""
    if hertz == 0.0 or normal.elastic <= 0.0:
        return normal
    rise = 4.0 * hertz * stiffness
    root = sqrt(1.0 + rise * max(normal.force, 0.0))
    elastic = 2.0 * normal.elastic / (1.0 + sqrt(1.0 + rise * normal.elastic))
    return NormalForce(
        2.0 * normal.force / (1.0 + root),
        normal.by_penetration / root,
        normal.by_rate / root,
        elastic,
        elastic * elastic * (0.5 / stiffness + 2.0 / 3.0 * hertz * elastic),
    )


@kernel
def point_tangent(
    here: Approach, force: PointForce, speed: float, by_position: float, by_velocity: float
) -> PointTangent:
    """Derivative of force and moment: by_position d/d(position) + by_velocity d/d(velocity).

    `here`: how the point stands and moves; `force`: result of `point_force`; `speed`: angular speed of the pulley,
    rad/s; `by_position`, `by_velocity`: factors of the two derivatives.
    """
    tilt, push = by_position * here.curvature, by_position * force.normal.force
    sink = -(by_position * force.normal.by_penetration + by_velocity * force.normal.by_rate)
    swing = here.circumferential * here.curvature + speed * here.turn
    sweep = -by_position * force.normal.by_rate * swing
    drag = by_velocity - here.radial * tilt
    friction_n = force.by_normal * sink - force.by_slip * by_position * speed * here.sinking
    friction_t = force.by_normal * sweep + force.by_slip * drag
    rolling = force.rolling
    roll = rolling.by_normal * sweep + rolling.by_velocity * (drag + speed * here.offset * tilt)
    turned = sweep - force.friction * tilt
    nn, nt = sink, turned - rolling.force * tilt
    tn, tt = friction_n + rolling.by_normal * sink, friction_t + roll + force.normal.force * tilt
    moment_n = sink * here.offset - by_position * force.arm_slope * force.friction - force.arm * friction_n
    moment_t = turned * here.offset + push * here.turn - force.arm * friction_t
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


@kernel
def point_turn(here: Approach, force: PointForce, speed: float, by_angle: float, by_speed: float) -> PointTurn:
    """Derivative of force and moment: by_angle d/d(theta) + by_speed d/d(omega); arguments as for `point_tangent`."""
    along = by_speed * (force.by_speed - force.by_slip * here.rim)
    if here.offset == 0.0 and here.turn == 0.0:
        return PointTurn(-along * here.normal_y, along * here.normal_x, -force.arm * along)
    tilt, lift = here.turn * by_angle, here.offset * by_angle
    rate = (here.circumferential - speed * here.lever) * tilt + here.offset * by_speed
    normal = -force.normal.by_penetration * lift - force.normal.by_rate * rate
    along += force.by_slip * ((1.0 - here.sinking) * speed * lift - here.radial * tilt) + force.by_normal * normal
    arm = here.offset * tilt - (1.0 - force.arm_slope) * lift
    moment = normal * here.offset - force.normal.force * here.lever * tilt - along * force.arm - force.friction * arm
    rolling = force.rolling
    across = normal - (force.friction + rolling.force) * tilt
    along += rolling.by_normal * normal - rolling.by_velocity * (here.radial - speed * here.offset) * tilt
    along += force.normal.force * tilt
    nx, ny = here.normal_x, here.normal_y
    return PointTurn(across * nx - along * ny, across * ny + along * nx, moment)

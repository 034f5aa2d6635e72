"""Force of teeth at a point of the belt, and its variation.

The groove of a tooth is ahead of it by the angle a (`beltdyn.contact.surface.toothed`), reduced to the nearest groove,
so that a tooth that is off by more than half a pitch has jumped.  With R_p the pitch radius and rho = |r - O|, misfit
and rate are

    delta = R_p a,    d(delta)/dt = R_p (omega - v_t / rho),

and the force on the belt along t is R_p / rho times

    q = k (delta without the backlash) + c d(delta)/dt    per length of belt,

with the moment -R_p q on the pulley: of a potential but for its damper.  Flanks of the angle phi to the normal push the
belt off by tan(phi) |q|, without what the damper adds.  Where it has lifted off the rim by z, they have z tan(phi) more
play to both sides, and a tooth of height h has the stiffness k (1 - (z / h)^2)^2, so that it enters and leaves its
groove smoothly.  Where crests meet, midway between two grooves, q goes through zero over a part of the pitch.  The
force has a potential: a belt that loads push off rides on the crests, and comes down in other grooves.

Spread teeth act at every point that has not lifted by the height.  Single teeth act at their middles alone, a pitch
apart, each with the force of a pitch of spread ones.
"""

from collections.abc import Callable
from math import atan2, floor
from typing import Any, Final, NamedTuple

from beltdyn.contact.penetration import Approach
from beltdyn.contact.point_force import PointForce, PointTangent, PointTurn
from beltdyn.contact.surface import Polygon, Round, Shaped
from beltdyn.contact.surface.toothed import Toothed
from beltdyn.kernel import by_type, kernel

LOOSE: Final = 1e-3
"""Stiffness of a tooth within its backlash over that beyond it: lands hold an idle pulley in its place."""
CREST: Final = 0.2
"""Part of half a pitch, up to where crests meet, over which the force of a tooth goes to zero."""


class NoTeeth(NamedTuple):
    """No tooth: the belt is smooth."""

    none: float
    """Zero."""


class Tooth(NamedTuple):
    """Force of teeth at a point, and how it changes."""

    traction: float
    """q, N/m."""
    slope: float
    """dq / d(delta), N/m^2."""
    damping: float
    """dq / d(d(delta)/dt), N s/m^2."""
    pitch_radius: float
    rate: float
    by_flow: float
    """As of `Toothed`."""
    misfit_rate: float
    """d(delta)/dt, m/s."""
    push: float
    """Force of the flanks on the belt along n, N/m."""
    push_slope: float
    """Its derivative by delta, N/m^2."""
    lift_slope: float
    """dq / dz of a belt that has lifted off the rim, N/m^2."""
    push_lift: float
    """Derivative of `push` by z there, N/m^2."""
    lift_rate: float
    """dz/dt, m/s."""


@kernel(inline=True)
def _no_tooth(surface: Any, here: Approach, speed: float, along: float) -> NoTeeth:
    return NoTeeth(0.0)


@kernel
def misfit_of(surface: Toothed, normal_x: float, normal_y: float, along: float) -> float:
    """Way from a tooth at a material coordinate (m), in a direction from the shaft, to the nearest groove, m."""
    angle = surface.phase - atan2(normal_y, normal_x) + surface.rate * along
    return surface.pitch_radius * (angle - surface.groove * floor(angle / surface.groove + 0.5))


class _Hold(NamedTuple):
    """Potential of a tooth over its stiffness at |delta| and half a play g, m^2, and its derivatives."""

    potential: float
    pull: float
    """By |delta|, m."""
    wedge: float
    """By -g, m."""
    stiffness: float
    """Of `pull` by |delta|."""
    mixed: float
    """Of `wedge` by |delta|."""
    by_gap: float
    """Of `wedge` by -g."""


@kernel(inline=True)
def _hold(off: float, gap: float, half_pitch: float) -> _Hold:
    """A tooth that is off its groove (m) by less than half a pitch."""
    last = (1.0 - CREST) * half_pitch
    seat = min(off, last)
    beyond = max(seat - gap, 0.0)
    held = 1.0 - LOOSE if seat > gap else 0.0
    potential = 0.5 * ((1.0 - LOOSE) * beyond * beyond + LOOSE * seat * seat)
    pull, wedge = (1.0 - LOOSE) * beyond + LOOSE * seat, held * beyond
    if off <= last:
        return _Hold(potential, pull, wedge, held + LOOSE, held, held)
    width = half_pitch - last
    left = (half_pitch - off) / width
    way = 0.5 * width * (1.0 - left * left)
    return _Hold(potential + pull * way, pull * left, wedge + held * way, -pull / width, held * left, held)


@kernel
def tooth_of(surface: Toothed, here: Approach, speed: float, along: float) -> Tooth:
    """Force of teeth at a material coordinate (m) on a pulley of a speed (rad/s), over their pitch."""
    misfit = misfit_of(surface, here.normal_x, here.normal_y, along)
    rate = surface.pitch_radius * (speed - here.circumferential / here.lever)
    lift, flank, sense = max(-here.penetration, 0.0), surface.flank, 1.0 if misfit > 0.0 else -1.0
    hold = _hold(abs(misfit), surface.half_gap + flank * lift, 0.5 * surface.pitch_radius * surface.groove)
    left, falls, bends = _left_of_height(lift, surface.height)
    pull, push = left * hold.pull, left * flank * hold.wedge - falls * hold.potential
    push_slope = left * flank * hold.mixed - falls * hold.pull
    lift_slope = push_lift = 0.0
    if lift > 0.0:
        push_lift = flank * (2.0 * falls * hold.wedge - left * flank * hold.by_gap) - bends * hold.potential
        lift_slope = surface.damping * falls * rate - sense * surface.stiffness * push_slope
    return Tooth(
        sense * surface.stiffness * pull + left * surface.damping * rate,
        surface.stiffness * left * hold.stiffness,
        left * surface.damping,
        surface.pitch_radius,
        surface.rate,
        surface.by_flow,
        rate,
        surface.stiffness * push,
        sense * surface.stiffness * push_slope,
        lift_slope,
        surface.stiffness * push_lift,
        here.radial,
    )


@kernel(inline=True)
def _left_of_height(lift: float, height: float) -> tuple[float, float, float]:
    """What is left of the stiffness of a lifted tooth, (1 - (z / h)^2)^2, and its derivatives by z, 1/m and 1/m^2."""
    if lift == 0.0:
        return 1.0, 0.0, 0.0
    if lift >= height:
        return 0.0, 0.0, 0.0
    part = lift / height
    inside = 1.0 - part * part
    return inside * inside, -4.0 * inside * part / height, 4.0 * (2.0 * part * part - inside) / (height * height)


@kernel
def _tooth(surface: Toothed, here: Approach, speed: float, along: float) -> Tooth:
    """Force of spread teeth; single ones leave none to the points between them."""
    if surface.spacing > 0.0:
        return Tooth(0.0, 0.0, 0.0, surface.pitch_radius, surface.rate, surface.by_flow, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return tooth_of(surface, here, speed, along)


tooth_at: Callable[[Any, Approach, float, float], Any] = by_type(
    {Round: _no_tooth, Shaped: _no_tooth, Toothed: _tooth, Polygon: _tooth}, "tooth_at"
)
"""Spread teeth at a point: of a surface, how the point stands, speed of the pulley (rad/s), material coordinate (m)."""


@kernel(inline=True)
def _no_reach(surface: Any) -> float:
    return 0.0


@kernel(inline=True)
def _reach(surface: Toothed) -> float:
    return surface.height if surface.spacing == 0.0 and surface.stiffness > 0.0 else 0.0


tooth_reach: Callable[[Any], float] = by_type(
    {Round: _no_reach, Shaped: _no_reach, Toothed: _reach, Polygon: _no_reach}, "tooth_reach"
)
"""Lift off the rim up to which a point of spread teeth is held, m."""


@kernel(inline=True)
def _traction_of_none(tooth: NoTeeth, here: Approach) -> float:
    return 0.0


@kernel(inline=True)
def _traction(tooth: Tooth, here: Approach) -> float:
    return tooth.traction * tooth.pitch_radius / here.lever


tooth_traction: Callable[[Any, Approach], float] = by_type(
    {NoTeeth: _traction_of_none, Tooth: _traction}, "tooth_traction"
)
"""Force of teeth on the belt along t, N/m."""


@kernel(inline=True)
def _no_push(tooth: NoTeeth) -> float:
    return 0.0


@kernel(inline=True)
def _push(tooth: Tooth) -> float:
    return tooth.push


tooth_push: Callable[[Any], float] = by_type({NoTeeth: _no_push, Tooth: _push}, "tooth_push")
"""Force of the flanks of teeth on the belt along n, N/m."""


@kernel(inline=True)
def _without(tooth: NoTeeth, force: PointForce, here: Approach) -> PointForce:
    return force


@kernel(inline=True)
def _with_teeth(tooth: Tooth, force: PointForce, here: Approach) -> PointForce:
    along = _traction(tooth, here)
    return PointForce(
        force.normal,
        force.friction,
        force.rolling,
        force.x + tooth.push * here.normal_x - along * here.normal_y,
        force.y + tooth.push * here.normal_y + along * here.normal_x,
        force.by_slip,
        force.by_normal,
        force.by_speed,
        force.moment - tooth.pitch_radius * tooth.traction,
        force.arm,
        force.arm_slope,
    )


force_with: Callable[[Any, PointForce, Approach], PointForce] = by_type(
    {NoTeeth: _without, Tooth: _with_teeth}, "force_with"
)
"""Contact force at a point with that of teeth."""


@kernel(inline=True)
def _tangent_without(
    tooth: NoTeeth, tangent: PointTangent, here: Approach, by_position: float, by_velocity: float
) -> PointTangent:
    return tangent


@kernel(inline=True)
def _tangent_with_teeth(
    tooth: Tooth, tangent: PointTangent, here: Approach, by_position: float, by_velocity: float
) -> PointTangent:
    bend, radius = here.curvature, tooth.pitch_radius
    swing = here.circumferential * bend * bend * by_position
    across = tooth.damping * radius * swing + tooth.lift_slope * by_position
    along = -tooth.slope * radius * bend * by_position
    along += tooth.damping * radius * bend * (here.radial * bend * by_position - by_velocity)
    tilt = by_position * bend * bend * radius * tooth.traction
    nn, nt = tooth.push_lift * by_position, -tilt - tooth.push_slope * radius * bend * by_position
    tn, tt = radius * bend * across - tilt, radius * bend * along + tooth.push * bend * by_position
    nx, ny = here.normal_x, here.normal_y
    xn, xt, yn, yt = nx * nn - ny * tn, nx * nt - ny * tt, ny * nn + nx * tn, ny * nt + nx * tt
    moment_n, moment_t = -radius * across, -radius * along
    return PointTangent(
        tangent.xx + xn * nx - xt * ny,
        tangent.xy + xn * ny + xt * nx,
        tangent.yx + yn * nx - yt * ny,
        tangent.yy + yn * ny + yt * nx,
        tangent.moment_x + moment_n * nx - moment_t * ny,
        tangent.moment_y + moment_n * ny + moment_t * nx,
    )


tangent_with: Callable[[Any, PointTangent, Approach, float, float], PointTangent] = by_type(
    {NoTeeth: _tangent_without, Tooth: _tangent_with_teeth}, "tangent_with"
)
"""Derivative of force and moment by position and velocity of a point, with that of teeth; see `point_tangent`."""


@kernel(inline=True)
def _turn_without(tooth: NoTeeth, turn: PointTurn, here: Approach, by_angle: float, by_speed: float) -> PointTurn:
    return turn


@kernel(inline=True)
def _turn_with_teeth(tooth: Tooth, turn: PointTurn, here: Approach, by_angle: float, by_speed: float) -> PointTurn:
    change = tooth.pitch_radius * (by_angle * tooth.slope + by_speed * tooth.damping)
    along = change * tooth.pitch_radius / here.lever
    off = tooth.pitch_radius * by_angle * tooth.push_slope
    return PointTurn(
        turn.x + off * here.normal_x - along * here.normal_y,
        turn.y + off * here.normal_y + along * here.normal_x,
        turn.moment - tooth.pitch_radius * change,
    )


turn_with: Callable[[Any, PointTurn, Approach, float, float], PointTurn] = by_type(
    {NoTeeth: _turn_without, Tooth: _turn_with_teeth}, "turn_with"
)
"""Derivative of force and moment by angle and speed of the pulley, with that of teeth; see `point_turn`."""


@kernel(inline=True)
def _speed_unknown(surface: Any) -> float:
    return 1.0


@kernel(inline=True)
def _own_speed_unknown(surface: Toothed) -> float:
    return surface.by_speed


speed_unknown: Callable[[Any], float] = by_type(
    {Round: _speed_unknown, Shaped: _speed_unknown, Toothed: _own_speed_unknown, Polygon: _own_speed_unknown},
    "speed_unknown",
)
"""1, or 0 of a pulley whose phase is unknown in place of its speed."""


@kernel(inline=True)
def _not_along(tooth: NoTeeth, here: Approach) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0


@kernel(inline=True)
def _by_coordinate(tooth: Tooth, here: Approach) -> tuple[float, float, float]:
    turn = _turn_with_teeth(tooth, PointTurn(0.0, 0.0, 0.0), here, 1.0, 0.0)
    return tooth.rate * turn.x, tooth.rate * turn.y, tooth.rate * turn.moment


by_coordinate: Callable[[Any, Approach], tuple[float, float, float]] = by_type(
    {NoTeeth: _not_along, Tooth: _by_coordinate}, "by_coordinate"
)
"""Derivative of force and moment by the material coordinate of a point that stays in its place, over m."""


@kernel(inline=True)
def _none_lost(tooth: NoTeeth) -> float:
    return 0.0


@kernel(inline=True)
def _taken(tooth: Tooth) -> float:
    return tooth.traction * tooth.misfit_rate - tooth.push * tooth.lift_rate


power_taken: Callable[[Any], float] = by_type({NoTeeth: _none_lost, Tooth: _taken}, "power_taken")
"""Power that teeth take from belt and pulley, stored or lost, W/m."""

"""Tensioners: where they hold their pulley, and how spring, dampers, dry friction and stops press it."""

from math import cos, sin, tanh

from beltdyn.kernel import kernel
from beltdyn.records import Records


@kernel
def tensioner_place(tensioners: Records, number: int, q: float) -> tuple[float, float, float, float, float, float]:
    """Center of the carried pulley, and its derivatives with respect to the coordinate of the tensioner.

    On a line, c + q u; on an arm of length a, p + a (cos phi u + sin phi n) with phi = sense q and n the left normal
    of u.

    Parameters
    ----------
    tensioners
        The tensioners.
    number
        Which one.
    q
        m or rad; zero at the nominal center, positive where it lengthens the path.

    Returns
    -------
    x, y, dx, dy, ddx, ddy : float
        Center, m, its first and its second derivative.
    """
    item = tensioners[number]
    x, y = item.origin
    ux, uy = item.direction
    if not item.rotary:
        return x + q * ux, y + q * uy, ux, uy, 0.0, 0.0
    sense = item.sense
    cosine, sine = item.arm * cos(q), item.arm * sense * sin(q)
    ax, ay = cosine * ux - sine * uy, cosine * uy + sine * ux
    return x + ax, y + ay, -sense * ay, sense * ax, -ax, -ay


@kernel
def tensioner_force(
    tensioners: Records, number: int, q: float, rate: float
) -> tuple[float, float, float, float, float]:
    """Generalised force of a tensioner on its coordinate, without weight.

    preload - k q - c v - dry friction + stops, where v is the rate of q.

    Parameters
    ----------
    tensioners
        The tensioners.
    number
        Which one.
    q, rate
        Its coordinate and the rate v, m and m/s, or rad and rad/s.

    Returns
    -------
    force, by_position, by_rate, energy, loss : float
        Force, N or N m, positive where it lengthens the path, and its derivatives; energy stored by spring and stops
        since q = 0, J; power lost, W.
    """
    item = tensioners[number]
    friction, friction_slope = dry_friction(rate, item.tensioning_friction, item.yielding_friction, item.creep_speed)
    force = item.preload - item.rate * q - item.viscous * rate - friction
    energy = (0.5 * item.rate * q - item.preload) * q
    by_position, by_rate = -item.rate, -item.viscous - friction_slope
    loss = (item.viscous * rate + friction) * rate
    if q > item.upper:
        depth, side = q - item.upper, 1.0
    elif q < item.lower:
        depth, side = item.lower - q, -1.0
    else:
        return force, by_position, by_rate, energy, loss
    spring, approach = item.stop_stiffness * depth, side * rate
    stop = spring + item.stop_damping * approach
    energy += 0.5 * spring * depth
    if stop <= 0.0:
        return force, by_position, by_rate, energy, loss - spring * approach
    return (
        force - side * stop,
        by_position - item.stop_stiffness,
        by_rate - item.stop_damping,
        energy,
        loss + item.stop_damping * rate * rate,
    )


@kernel
def dry_friction(rate: float, tensioning: float, yielding: float, creep_speed: float) -> tuple[float, float]:
    """Dry friction against the motion of a tensioner: f tanh(v / v_c), with an f for each sense.

    Parameters
    ----------
    rate
        v, m/s or rad/s, positive where the path gets longer.
    tensioning, yielding
        f for positive and for negative rates, N or N m.
    creep_speed
        v_c, m/s or rad/s, over which friction builds up.

    Returns
    -------
    friction, slope : float
        Friction, which has the sign of the rate, and its derivative, that for positive rates at zero.
    """
    largest = tensioning if rate >= 0.0 else yielding
    rise = tanh(rate / creep_speed)
    return largest * rise, largest * (1.0 - rise * rise) / creep_speed

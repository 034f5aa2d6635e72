"""What loads and motors apply to a shaft, over time, speed and angle."""

from math import cos, sin, tanh

from beltdyn.kernel import kernel
from beltdyn.system.excitation import profile_value
from beltdyn.system.machine_arrays import KLOSS, TABLE, Profiles, Torques


@kernel
def shaft_torque(
    profiles: Profiles, torques: Torques, pulley: int, time: float, angle: float, speed: float
) -> tuple[float, float, float]:
    """Torque on the shaft of a free pulley: its profile over time, and its loads.

    A load is schedule(t) f(omega) (1 + sum a_k cos(k theta + phi_k)), with f of its kind.

    Parameters
    ----------
    profiles, torques
        Functions of time, and loads.
    pulley
        Which one.
    time
        s.
    angle, speed
        Angle theta and speed omega of the shaft, rad and rad/s, counter-clockwise.

    Returns
    -------
    torque, by_angle, by_speed : float
        Torque, N m, counter-clockwise, and its derivatives.
    """
    total, by_angle, by_speed = profile_value(profiles, pulley, time)[0], 0.0, 0.0
    for load in range(torques.first[pulley], torques.first[pulley + 1]):
        schedule = torques.table[load].schedule
        scale = profile_value(profiles, schedule, time)[0] if schedule >= 0 else 1.0
        torque, by_theta, by_omega = load_torque(torques, load, angle, speed)
        total += scale * torque
        by_angle += scale * by_theta
        by_speed += scale * by_omega
    return total, by_angle, by_speed


@kernel
def load_torque(torques: Torques, load: int, angle: float, speed: float) -> tuple[float, float, float]:
    """Torque of a load without its schedule, N m, and its derivatives with respect to angle and speed."""
    torque, slope = _characteristic(torques, load, speed)
    factor, change = _harmonic_factor(torques, load, angle)
    return torque * factor, torque * change, slope * factor


@kernel
def resistance(
    speed: float, constant: float, creep_speed: float, linear: float, quadratic: float
) -> tuple[float, float]:
    """Resistance that opposes the motion: -(c tanh(omega / omega_c) + l omega + q omega |omega|).

    Parameters
    ----------
    speed
        omega, rad/s.
    constant
        c, N m.
    creep_speed
        omega_c, rad/s, over which the constant part builds up (dry friction, regularised).
    linear, quadratic
        l, N m s/rad, and q, N m s^2/rad^2.

    Returns
    -------
    torque, slope : float
        N m, N m s/rad.
    """
    rise = tanh(speed / creep_speed)
    torque = constant * rise + (linear + quadratic * abs(speed)) * speed
    slope = constant * (1.0 - rise * rise) / creep_speed + linear + 2.0 * quadratic * abs(speed)
    return -torque, -slope


@kernel
def kloss(
    speed: float, breakdown_torque: float, breakdown_slip: float, synchronous_speed: float
) -> tuple[float, float]:
    """Torque of an induction motor: M = 2 M_b / (s / s_b + s_b / s), s = 1 - omega / omega_s (Kloss's formula).

    It drives below the synchronous speed, brakes above, and counts in the sense of the synchronous speed.
    Source: M. Kloss, "Drehmoment und Schlüpfung des Drehstrommotors", Archiv für Elektrotechnik 5 (1916).

    Parameters
    ----------
    speed
        omega, rad/s.
    breakdown_torque, breakdown_slip
        The largest torque M_b, N m, and the slip s_b at which it is reached.
    synchronous_speed
        omega_s, rad/s, not zero; negative for a clockwise motor.

    Returns
    -------
    torque, slope : float
        N m, N m s/rad.
    """
    sense = 1.0 if synchronous_speed > 0.0 else -1.0
    slip = 1.0 - speed / synchronous_speed
    square = slip * slip + breakdown_slip * breakdown_slip
    top = 2.0 * sense * breakdown_torque * breakdown_slip
    by_slip = top * (breakdown_slip * breakdown_slip - slip * slip) / (square * square)
    return top * slip / square, -by_slip / synchronous_speed


@kernel(inline=True)
def _characteristic(torques: Torques, load: int, speed: float) -> tuple[float, float]:
    """Torque of a load over the speed, and its slope."""
    kind = torques.table[load].kind
    a, b, c, d = torques.table[load].constants
    if kind == TABLE:
        return _interpolate(torques, load, speed)
    if kind == KLOSS:
        return kloss(speed, a, b, c)
    return resistance(speed, a, b, c, d)


@kernel(inline=True)
def _interpolate(torques: Torques, load: int, speed: float) -> tuple[float, float]:
    """Linear between the points of a table, constant outside."""
    first, last = torques.table[load].point, torques.table[load + 1].point - 1
    points = torques.point
    if speed <= points[first].speed:
        return points[first].torque, 0.0
    if speed >= points[last].speed:
        return points[last].torque, 0.0
    while last - first > 1:
        middle = (first + last) // 2
        if points[middle].speed <= speed:
            first = middle
        else:
            last = middle
    slope = (points[last].torque - points[first].torque) / (points[last].speed - points[first].speed)
    return points[first].torque + slope * (speed - points[first].speed), slope


@kernel(inline=True)
def _harmonic_factor(torques: Torques, load: int, angle: float) -> tuple[float, float]:
    """1 + sum a_k cos(k theta + phi_k), and its derivative with respect to theta."""
    factor, change = 1.0, 0.0
    for h in range(torques.table[load].harmonic, torques.table[load + 1].harmonic):
        wave = torques.harmonic[h]
        factor += wave.amplitude * cos(wave.order * angle + wave.phase)
        change -= wave.amplitude * wave.order * sin(wave.order * angle + wave.phase)
    return factor, change

"""Prescribed speeds, applied torques and schedules: a profile and its integral at an instant (Eqs. 28 and 29)."""

from math import cos, sin

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import System
from beltdyn.system.machine_arrays import Profiles


@kernel
def profile_value(profiles: Profiles, number: int, time: float) -> tuple[float, float]:
    """Value of a profile and its rate, without harmonics.

    A segment holds for start < t <= next start and is c0 + c1 (t - start) + amplitude cos(omega t + phase).

    Parameters
    ----------
    profiles
        The profiles.
    number
        Which one.
    time
        s.

    Returns
    -------
    value, rate : float
        Speed and angular acceleration (rad/s, rad/s^2), torque and its rate (N m, N m/s), or factor and rate (1/s).
    """
    k = _segment(profiles, number, time)
    constant, slope, amplitude, omega, phase = profiles.segment[k].coefficients
    since = time - profiles.segment[k].start if slope != 0.0 else 0.0
    return (
        constant + slope * since + amplitude * cos(omega * time + phase),
        slope - amplitude * omega * sin(omega * time + phase),
    )


@kernel
def after_jump(time: float) -> float:
    """The next number after an instant (s): there a profile that jumps at the instant has jumped."""
    return float(np.nextafter(time, np.inf))


@kernel
def profile_angle(profiles: Profiles, number: int, time: float) -> float:
    """Integral of a profile from time zero, without harmonics: the angle of a mean speed.

    Within a segment of start s the integral from s to t is
    h (c0 + c1 h / 2 + amplitude cos(omega (s + t) / 2 + phase) sin(x) / x) with h = t - s, x = omega h / 2.

    Parameters
    ----------
    profiles
        The profiles.
    number
        Which one.
    time
        s.

    Returns
    -------
    float
        rad, where the profile is a speed.
    """
    k = _segment(profiles, number, time)
    begin = profiles.segment[k].start if k > profiles.table[number].segment else 0.0
    constant, slope, amplitude, omega, phase = profiles.segment[k].coefficients
    since = time - begin
    half = 0.5 * omega * since
    wave = sin(half) / half if half != 0.0 else 1.0
    mean = constant + 0.5 * slope * since + amplitude * wave * cos(0.5 * omega * (begin + time) + phase)
    return float(profiles.segment[k].angle + mean * since)


@kernel
def profile_bend(profiles: Profiles, number: int, time: float) -> tuple[float, float]:
    """Where a profile bends: its next kink, and the angular frequency of the wave that it is until then.

    Parameters
    ----------
    profiles
        The profiles; harmonics are left out.
    number
        Which one.
    time
        s.

    Returns
    -------
    kink, frequency : float
        s, infinite after the last kink; rad/s, zero where the profile is straight.
    """
    k = _segment(profiles, number, after_jump(time))
    last = k + 1 == profiles.table[number + 1].segment
    _, _, amplitude, omega, _ = profiles.segment[k].coefficients
    return np.inf if last else profiles.segment[k + 1].start, abs(omega) if amplitude != 0.0 else 0.0


@kernel
def prescribed_motion(profiles: Profiles, number: int, time: float) -> tuple[float, float, float]:
    """Prescribed speed with its harmonics: omega = m (1 + sum a_k cos(k theta + phi_k)), theta the integral of m.

    Parameters
    ----------
    profiles
        The profiles; the value is the mean speed m.
    number
        Which one.
    time
        s.

    Returns
    -------
    angle, speed, acceleration : float
        rad since time zero, rad/s, rad/s^2.
    """
    mean, rate = profile_value(profiles, number, time)
    angle = profile_angle(profiles, number, time)
    turned, factor, change = angle, 1.0, 0.0
    for h in range(profiles.table[number].harmonic, profiles.table[number + 1].harmonic):
        order, amplitude = profiles.harmonic[h].order, profiles.harmonic[h].amplitude
        phase = profiles.harmonic[h].phase
        turned += amplitude / order * (sin(order * angle + phase) - sin(phase))
        factor += amplitude * cos(order * angle + phase)
        change -= amplitude * order * sin(order * angle + phase)
    return turned, mean * factor, rate * factor + mean * mean * change


@kernel
def prescribe(
    system: System, time: float, position: FloatArray, velocity: FloatArray, acceleration: FloatArray
) -> None:
    """Write the motion of the prescribed shafts into a state.

    Parameters
    ----------
    system
        The system.
    time
        s.
    position, velocity, acceleration : ndarray, shape (6 N + D,)
        The entries of prescribed bodies are overwritten.
    """
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown < 0:
            i = system.first_body + body
            position[i], velocity[i], acceleration[i] = prescribed_motion(system.profiles, p, time)


@kernel(inline=True)
def _segment(profiles: Profiles, number: int, time: float) -> int:
    """Segment that holds at an instant."""
    first, last = profiles.table[number].segment, profiles.table[number + 1].segment - 1
    while first < last:
        middle = (first + last + 1) // 2
        if profiles.segment[middle].start < time:
            first = middle
        else:
            last = middle - 1
    return int(first)

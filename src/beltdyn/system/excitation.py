"""Prescribed speeds and applied torques: the segments of a profile at an instant (Eqs. 28 and 29)."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from beltdyn.kernel import kernel
from beltdyn.system.arrays import Pulleys, System

FloatArray = NDArray[np.float64]


@kernel
def profile_value(pulleys: Pulleys, pulley: int, time: float) -> tuple[float, float]:
    """Value of a pulley's profile and its rate.

    A segment holds for start < t <= next start and is c0 + c1 (t - start) + amplitude cos(omega t + phase).

    Parameters
    ----------
    pulleys
        The pulleys.
    pulley
        Which one.
    time
        s.

    Returns
    -------
    value, rate : float
        Speed and angular acceleration of a prescribed pulley (rad/s, rad/s^2), or torque and its rate of a free one
        (N m, N m/s).
    """
    first, last = pulleys.profile_first[pulley], pulleys.profile_first[pulley + 1] - 1
    while first < last:
        middle = (first + last + 1) // 2
        if pulleys.profile_start[middle] < time:
            first = middle
        else:
            last = middle - 1
    constant, slope, amplitude, omega, phase = pulleys.profile[first]
    since = time - pulleys.profile_start[first] if slope != 0.0 else 0.0
    return (
        constant + slope * since + amplitude * cos(omega * time + phase),
        slope - amplitude * omega * sin(omega * time + phase),
    )


@kernel
def prescribe(system: System, time: float, velocity: FloatArray, acceleration: FloatArray) -> None:
    """Write the speeds of the prescribed pulleys and their rates into a state.

    Parameters
    ----------
    system
        The system.
    time
        s.
    velocity, acceleration : ndarray, shape (6 N + P,)
        The entries of prescribed pulleys are overwritten.
    """
    first = velocity.size - system.pulleys.radius.size
    for p in range(system.pulleys.radius.size):
        if system.pulleys.unknown[p] < 0:
            velocity[first + p], acceleration[first + p] = profile_value(system.pulleys, p, time)

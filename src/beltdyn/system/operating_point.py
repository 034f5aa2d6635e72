"""The speed at which motors and loads balance where nothing slips: the start of a search for steady running."""

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.system.arrays import System

_SPEEDS = np.geomspace(1e-2, 300.0, 100)
"""Speeds of the belt at which the balance is looked at, m/s."""


def operating_point(system: System, radii: FloatArray, prescribed: BoolArray) -> tuple[float, int | None]:
    """Find the belt's speed without slip.

    Parameters
    ----------
    system
        With constant speeds, torques and schedules.
    radii : ndarray, shape (P,)
        Signed radii of the path, m.
    prescribed : ndarray of bool, shape (P,)
        Which shafts have a prescribed speed.

    Returns
    -------
    speed : float
        m/s, positive in the sense of the path.
    driver : int or None
        The pulley whose torque drives, where no speed is prescribed.

    Raises
    ------
    ModelError
        If nothing drives.
    """
    from scipy.optimize import brentq

    driven = np.flatnonzero(prescribed)
    if driven.size:
        speeds = system.profiles.segment.offset[driven] * radii[driven]
        fastest = float(speeds[np.argmax(np.abs(speeds))])
        if fastest == 0.0:
            raise ModelError("nothing drives the belt: every prescribed speed is zero.")
        return fastest, None
    for sense in (1.0, -1.0):

        def pull(size: float, sense: float = sense) -> float:
            return sense * float(np.sum(_pulls(system, radii, sense * size)))

        pulls = np.array([pull(size) for size in _SPEEDS])
        crossing = np.flatnonzero((pulls[:-1] > 0.0) & (pulls[1:] <= 0.0))
        if crossing.size:
            k = int(crossing[0])
            speed = sense * brentq(pull, _SPEEDS[k], _SPEEDS[k + 1])
            return speed, int(np.argmax(sense * _pulls(system, radii, speed)))
    raise ModelError(
        "the drive has no operating point: its motors and loads balance at no speed. Prescribe a speed, use a "
        "motor stronger than the loads at rest, or a load that grows with speed."
    )


def _pulls(system: System, radii: FloatArray, speed: float) -> FloatArray:
    """Force with which each shaft pulls the belt along at a speed (m/s) without slip, N, shape (P,)."""
    torque, states = interpreted(shaft_torque), np.zeros(system.bodies.size)
    found = [
        torque(system.profiles, system.shaft_loads, p, 0.0, 0.0, speed / radius, states).torque / radius
        for p, radius in enumerate(radii)
    ]
    return np.array(found)

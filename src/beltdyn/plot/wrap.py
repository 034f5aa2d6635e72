"""The part of the belt that lies on a pulley, laid out from where the belt enters."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Wrap:
    """Contact points on a pulley, from where the belt enters to where it leaves.

    Attributes
    ----------
    points : ndarray, shape (k,)
        Numbers of the contact points, free ones between touching ones included.
    distance : ndarray, shape (k,)
        Unstretched length of belt between the first of them and each, m.
    """

    points: IntArray
    distance: FloatArray


def unwrap(belt_coordinate: FloatArray, touching: BoolArray, length: float, speed: float) -> Wrap:
    """Find the contiguous part of a closed belt that lies on a pulley.

    The part is what is left of the belt when its longest free stretch is taken away.

    Parameters
    ----------
    belt_coordinate : ndarray, shape (points,)
        Belt coordinates of all contact points, ascending, m.
    touching : ndarray of bool, shape (points,)
        Which of them touch the pulley.
    length : float
        Unstretched length of the belt, m.
    speed : float
        Speed of the pulley; with a negative one the belt enters at the other end.

    Returns
    -------
    Wrap
        The points and their distances from where the belt enters; empty when nothing touches.
    """
    (on,) = np.nonzero(touching)
    if on.size == 0:
        return Wrap(on, np.empty(0))
    count = len(belt_coordinate)
    gaps = np.diff(belt_coordinate[on], append=belt_coordinate[on[0]] + length)
    widest = int(np.argmax(gaps))
    first, last = on[(widest + 1) % on.size], on[widest]
    points = (first + np.arange((last - first) % count + 1)) % count
    distance = (belt_coordinate[points] - belt_coordinate[first]) % length
    if speed < 0.0:
        return Wrap(points[::-1], distance[-1] - distance[::-1])
    return Wrap(points, distance)

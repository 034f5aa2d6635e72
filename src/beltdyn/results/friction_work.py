"""Work of friction by place on the arcs and by place on the belt, integrated over the steps of a run."""

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.results.arc import angle_from_inlet, arc_ends

ARC_PARTS = 60
"""Equal parts of an arc in which work is summed up."""

BEYOND = 0.25
"""Share of the arc between the tangent points by which these parts reach further at both of its ends."""


def arc_shares() -> FloatArray:
    """Middles of the parts of an arc as shares of it: 0 where the belt's path reaches the pulley, 1 where it leaves."""
    return (1.0 + 2.0 * BEYOND) * (np.arange(ARC_PARTS) + 0.5) / ARC_PARTS - BEYOND


class FrictionWork:
    """Integrals over time of the power |f_t v_t|, by the trapezoidal rule over successive states.

    Parameters
    ----------
    drive : Drive
        The drive.
    cell : ndarray, shape (points,)
        Length of belt that each contact point stands for, m.
    elements : int
        Number of pieces of the belt, each with as many contact points.
    """

    def __init__(self, drive: Drive, cell: FloatArray, elements: int) -> None:
        self._drive, self._cell, self._elements = drive, cell, elements
        pulleys = len(drive.pulleys)
        self._time = -np.inf
        self._power = np.zeros((pulleys, ARC_PARTS + elements))
        self._work = np.zeros((pulleys, ARC_PARTS + elements))

    def take(
        self, time: FloatArray, centers: FloatArray, places: FloatArray, touched: IntArray, intensity: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Go on to further states.

        Parameters
        ----------
        time : ndarray, shape (k,)
            s.
        centers : ndarray, shape (k, pulleys, 2)
            Where the pulleys are, m.
        places : ndarray, shape (k, points, 2)
            Where the contact points are, m.
        touched : ndarray of int, shape (k, points)
            Number of the pulley that each touches, -1 where it is free.
        intensity : ndarray, shape (k, points)
            |f_t v_t|, W/m.

        Returns
        -------
        by_arc : ndarray, shape (k, pulleys, ARC_PARTS)
            Work since the first state, J.
        by_belt : ndarray, shape (k, pulleys, elements)
            The same by place on the belt.
        """
        power = self._powers(centers, places, touched, intensity * self._cell)
        passed = np.diff(time, prepend=time[0] if np.isinf(self._time) else self._time)
        before = np.concatenate([self._power[None], power[:-1]])
        work = self._work + np.cumsum(0.5 * passed[:, None, None] * (before + power), axis=0)
        self._time, self._power, self._work = float(time[-1]), power[-1], work[-1]
        return work[..., :ARC_PARTS], work[..., ARC_PARTS:]

    def _powers(self, centers: FloatArray, places: FloatArray, touched: IntArray, power: FloatArray) -> FloatArray:
        """Power by part of the arc and by element, W, shape (k, pulleys, parts + elements)."""
        row, point = np.nonzero(touched >= 0)
        pulley, some = touched[row, point], power[row, point]
        inlet, wrap = arc_ends(self._drive, centers)
        turning = np.array([one.turning for one in self._drive.pulleys])[pulley]
        away = places[row, point] - centers[row, pulley]
        angle = angle_from_inlet(away, inlet[row, pulley], wrap[row, pulley], turning)
        share = np.divide(angle, wrap[row, pulley], out=np.zeros_like(angle), where=wrap[row, pulley] > 0.0)
        part = np.clip(((share + BEYOND) / (1.0 + 2.0 * BEYOND) * ARC_PARTS).astype(int), 0, ARC_PARTS - 1)
        element = point // (power.shape[1] // self._elements)
        shape = (len(power), *self._power.shape)
        at_arc, at_belt = (
            np.bincount(np.ravel_multi_index((row, pulley, where), shape), some, int(np.prod(shape)))
            for where in (part, ARC_PARTS + element)
        )
        return np.asarray(at_arc + at_belt, dtype=float).reshape(shape)

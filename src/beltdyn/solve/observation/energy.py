"""The energy account of a run: what goes in, what is stored, what is lost, and whether that adds up."""

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray


class EnergyAccount:
    """Closure error over time, relative to the energy put in.

    With the energy E of the belt and the bodies (kinetic, strain and penalty), and V of springs, and of weight and
    forces on ends, whose zero is anywhere, the error is

        (E(t) - E(0) + V(t) - V(0) - driver work - torque work + losses) / energy put in,

    where the energy put in up to t is E(0) plus the largest amounts that drivers, torques, springs and weight have
    done by then, either way.
    """

    def __init__(self) -> None:
        self._initial: tuple[float, FloatArray] | None = None
        self._largest = np.zeros(4)

    def closure(self, stored: FloatArray, potential: FloatArray, work: FloatArray, shown: BoolArray) -> FloatArray:
        """Closure error in some of several successive states.

        Parameters
        ----------
        stored : ndarray, shape (m,)
            E in those that are shown, J; the first state of all is one of them.
        potential : ndarray, shape (k, 2)
            V of springs and of weight, J.
        work : ndarray, shape (k, 10)
            In the order of `ENERGY_WORKS`: driver work, torque work, then losses, J.
        shown : ndarray of bool, shape (k,)
            Which m of them are.

        Returns
        -------
        ndarray, shape (m,)
            Zero as long as no energy was put in at all.
        """
        if self._initial is None:
            self._initial = float(stored[0]), potential[0].copy()
        initial, level = self._initial
        done = np.hstack([work[:, :2], level - potential])
        largest = np.maximum.accumulate(np.vstack([self._largest, np.abs(done)]))
        self._largest = largest[-1]
        put_in = initial + largest[1:][shown].sum(axis=1)
        error = stored - initial - done[shown].sum(axis=1) + work[shown, 2:].sum(axis=1)
        return np.asarray(np.divide(error, put_in, out=np.zeros_like(error), where=put_in > 0.0))

"""The energy account of a run: what goes in, what is stored, what is lost, and whether that adds up."""

import numpy as np

from beltdyn.system.arrays import FloatArray


class EnergyAccount:
    """Closure error over time, relative to the energy put in.

    With the stored energy E (kinetic, strain, potential, and that of penalty and other springs) the error is

        (E(t) - E(0) - driver work - torque work + losses) / energy put in,

    where the energy put in up to t is E(0) plus the largest amounts that drivers and torques have done by then,
    either way.
    """

    def __init__(self) -> None:
        self._initial: float | None = None
        self._largest = np.zeros(2)

    def closure(self, stored: FloatArray, work: FloatArray) -> FloatArray:
        """Closure error at successive outputs.

        Parameters
        ----------
        stored : ndarray, shape (k,)
            Stored energy, J.
        work : ndarray, shape (k, 7)
            In the order of `POWERS`: driver work, torque work, then losses, J.

        Returns
        -------
        ndarray, shape (k,)
            Zero as long as no energy was put in at all.
        """
        if self._initial is None:
            self._initial = float(stored[0])
        largest = np.maximum.accumulate(np.vstack([self._largest, np.abs(work[:, :2])]))
        self._largest = largest[-1]
        put_in = self._initial + largest[1:].sum(axis=1)
        error = stored - self._initial - work[:, 0] - work[:, 1] + work[:, 2:].sum(axis=1)
        return np.asarray(np.divide(error, put_in, out=np.zeros_like(error), where=put_in > 0.0))

"""Largest energy balance error and numerical loss of a run."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.results.recorded import Recorded


class Closure(NamedTuple):
    """Largest energy balance error of a run.

    Attributes
    ----------
    time : float
        When, s.
    error : float
        Closure error at that time, over the energy put in by then.
    """

    time: float
    error: float


def largest_closure(recorded: Recorded) -> Closure:
    """Largest energy balance error over time.

    Parameters
    ----------
    recorded : Recorded
        The results, with at least one output.

    Returns
    -------
    Closure
        The error of largest magnitude with its sign, and its instant; the first NaN if there is one.
    """
    return _largest(recorded, np.asarray(recorded["energy_closure"]))


def largest_numerical_share(recorded: Recorded) -> Closure:
    """Largest share of the energy input lost in time integration.

    Parameters
    ----------
    recorded : Recorded
        The results, with at least one output.

    Returns
    -------
    Closure
        The share of largest magnitude with its sign, and its instant.
    """
    taken, given = np.asarray(recorded["numerical_loss"]), energy_put_in(recorded)
    shares = np.divide(taken, given, out=np.zeros_like(given), where=given > 0.0)
    return _largest(recorded, shares)


def _largest(recorded: Recorded, shares: FloatArray) -> Closure:
    """The share of largest magnitude, and its instant."""
    worst = int(np.argmax(np.abs(shares)))
    return Closure(float(recorded["time"][worst]), float(shares[worst]))


def energy_put_in(recorded: Recorded) -> FloatArray:
    """Energy put in up to each output: what was stored at first, and the largest works of each kind by then.

    Parameters
    ----------
    recorded : Recorded
        The results, with at least one output.

    Returns
    -------
    ndarray, shape (outputs,)
        J; works of drivers and torques, and of springs and weight, either way.
    """

    def values(name: str) -> FloatArray:
        return np.asarray(recorded[name], dtype=np.float64)

    stored = sum(float(values(name)[0]) for name in ("kinetic_energy", "strain_energy", "penalty_energy"))
    kinds = ("driver_work", "torque_work", "spring_energy", "potential_energy")
    done = np.abs(np.stack([values(name) - values(name)[0] for name in kinds]))
    return np.asarray(stored + np.maximum.accumulate(done, axis=1).sum(axis=0))

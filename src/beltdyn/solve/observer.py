"""What is seen at successive states of a simulation: there, at ends of steps, the equations of motion hold."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results.contact_scalars import contact_scalars
from beltdyn.results.friction_work import FrictionWork
from beltdyn.solve.energy import EnergyAccount
from beltdyn.solve.flutter import Flutter, FlutterWatch
from beltdyn.solve.trajectory import Chunk
from beltdyn.system.arrays import ENERGY_WORKS, System
from beltdyn.system.discretization import curve_lengths
from beltdyn.system.observe import observe

Arrays = dict[str, NDArray[Any]]

WORKS = ("friction_work_on_arc", "friction_work_on_belt")
"""Variables that are seen as integrals from the start on, and recorded as what they grow by."""


_VALUES_OF_SPANS = ("span_tension", "belt_speed")


class Observer:
    """Sees successive states, and keeps what has to be summed up over all of them.

    Parameters
    ----------
    drive, system
        What is simulated.
    belt_coordinate : ndarray, shape (points,)
        Of the contact points, m.
    """

    def __init__(self, drive: Drive, system: System, belt_coordinate: FloatArray) -> None:
        self._drive, self._system, self._belt_coordinate = drive, system, belt_coordinate
        lengths = curve_lengths(system)
        self._friction_work = FrictionWork(drive, np.outer(lengths, system.contact.weights).ravel(), len(lengths))
        self._energy = EnergyAccount()
        self._flutter = FlutterWatch(system)

    def see(self, states: Chunk) -> Arrays:
        """Every recorded variable at further states but those that are coordinates and their rates.

        Parameters
        ----------
        states
            At least one state.

        Returns
        -------
        dict
            Name -> array with one row for each state.
        """
        seen: Arrays = observe(self._system, states.time, states.position, states.velocity)._asdict()
        _require_numbers(states.time, seen)
        self._flutter.take(states.time, states.position, states.velocity, seen)
        touched, places, centers = (seen[name] for name in ("contact_pulley", "contact_position", "pulley_center"))
        normal, slip = seen["normal_force"], seen["slip_velocity"]
        intensity = np.abs(seen["friction_force"] * slip)
        works = self._friction_work.take(states.time, centers, places, touched, intensity)
        scalars = contact_scalars(self._drive, self._belt_coordinate, touched, normal, slip, places, centers)
        stored = seen["kinetic_energy"] + seen["strain_energy"] + seen["penalty_energy"]
        potential = np.stack([seen["spring_energy"], seen["potential_energy"]], axis=1)
        return {
            **seen,
            **scalars,
            **dict(zip(WORKS, works, strict=True)),
            **dict(zip(ENERGY_WORKS, states.work.T, strict=True)),
            "energy_closure": self._energy.closure(stored, potential, states.work),
        }

    def find_flutter(self) -> Flutter | None:
        """The largest growth of vibrations while the belt slid; None where none grows."""
        return self._flutter.find()


def _require_numbers(time: FloatArray, seen: Arrays) -> None:
    """Make sure that all that is seen has a value, but spans whose pulleys the belt has left.

    Raises
    ------
    ConvergenceError
        If something has none.
    """
    for name, values in seen.items():
        if name not in _VALUES_OF_SPANS and not np.isfinite(values.sum()):
            first = int(np.argmin(np.isfinite(values.reshape(len(time), -1)).all(axis=1)))
            raise ConvergenceError(
                f"the simulation cannot go on at t = {time[first]:.6g} s: {name} has no finite value. "
                "Check loads and stiffnesses for numbers beyond all measure, or reduce simulation.max_step."
            )

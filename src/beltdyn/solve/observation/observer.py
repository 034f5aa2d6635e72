"""What is seen at successive states of a simulation: there, at ends of steps, the equations of motion hold."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results.friction_work import FrictionWork, Touch
from beltdyn.results.material_work import MaterialWork
from beltdyn.results.mid_span import mid_span_displacements
from beltdyn.results.schema import FILTERED
from beltdyn.results.sliding import sliding_of_pulleys
from beltdyn.solve.integrators.trajectory import Chunk
from beltdyn.solve.observation.energy import EnergyAccount
from beltdyn.solve.vibration.flutter import Flutter, FlutterWatch
from beltdyn.system.arrays import BENDING_LOSS, ENERGY_WORKS, STRETCH_LOSS, System
from beltdyn.system.discretization import curve_lengths
from beltdyn.system.frame import Flowing, Travelling
from beltdyn.system.observations import OBSERVED
from beltdyn.system.observe import observe_motion
from beltdyn.system.pulley_state import pulley_speeds

Arrays = dict[str, NDArray[Any]]


class Seen(NamedTuple):
    """What is seen at successive states."""

    at_outputs: Arrays
    """Recorded variables at those states that are shown."""
    for_spectra: Arrays
    """Those that are filtered over all states, at every state."""


WORKS = ("friction_work_on_arc", "friction_work_on_belt")
"""Variables that are seen as integrals from the start on, and recorded as what they grow by."""


_VALUES_OF_SPANS = ("span_tension", "belt_speed", "mid_span_displacement")
_OF_SHOWN = frozenset(name for name, per in OBSERVED.items() if per.shown)
"""Observations that are there for states that are shown alone."""


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
        self._shares = lengths / np.sum(lengths)
        self._friction_work = FrictionWork(drive, np.outer(lengths, system.contact.weights).ravel(), len(lengths))
        self._material_work = MaterialWork(lengths)
        self._energy = EnergyAccount()
        self._flutter = None if isinstance(system.frame, Flowing) else FlutterWatch(system)

    def see(self, states: Chunk, shown: BoolArray) -> Seen:
        """Every recorded variable at further states but those that are coordinates and their rates.

        Parameters
        ----------
        states
            At least one state.
        shown : ndarray of bool, shape (k,)
            For which states all of them are wanted; for the very first one.

        Returns
        -------
        Seen
            Name -> array with one row for each state that is shown; and what spectra show, of every state.
        """
        seen = observe_motion(self._system, states.position, states.velocity, states.forces, shown)
        touched, centers, places = seen.contact_pulley, seen.pulley_center, seen.contact_position
        aside = mid_span_displacements(self._drive, centers, places, touched)
        lost = np.abs(seen.friction_force * seen.slip_velocity)
        on_arc, on_belt = self._works(Touch(states.time, centers, places, touched, lost), states, shown)
        potential = np.stack([seen.spring_energy, seen.potential_energy], axis=1)
        stored = seen.kinetic_energy + seen.strain_energy + seen.penalty_energy[shown]
        closure = self._energy.closure(stored, potential, states.work, shown)
        every = seen._asdict() | {"mid_span_displacement": aside}
        _require_numbers(states.time, shown, every)
        if self._flutter:
            self._flutter.take(states.time, states.position, states.velocity, every)
        rows = {name: values if name in _OF_SHOWN else values[shown] for name, values in every.items()}
        at_outputs = {
            **rows,
            **sliding_of_pulleys(
                self._drive,
                self._belt_coordinate,
                rows["contact_pulley"],
                rows["normal_force"],
                rows["slip_velocity"],
                pulley_speeds(self._system, states.velocity[shown]),
            ),
            **dict(zip(WORKS, (on_arc, on_belt), strict=True)),
            **dict(zip(ENERGY_WORKS, states.work[shown].T, strict=True)),
            "material_loss": states.work[shown][:, [STRETCH_LOSS, BENDING_LOSS]].sum(axis=1),
            "energy_closure": closure,
        }
        return Seen(at_outputs, {name: values for name, values in every.items() if name in FILTERED})

    def _works(self, touch: Touch, states: Chunk, shown: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Work of friction since the beginning by arc and by belt, in the states that are shown.

        Where the belt flows through the mesh, it is spread on what passes in each step, whichever states are shown.
        """
        frame = self._system.frame
        if isinstance(frame, Flowing):
            on_arc, on_mesh = self._friction_work.take(touch, np.ones_like(shown))
            return on_arc[shown], self._material_work.take(on_mesh, states.position[:, frame.place])[shown]
        on_arc, on_belt = self._friction_work.take(touch, shown)
        if not isinstance(frame, Travelling):  # all of the belt passes
            on_belt = np.sum(on_belt, axis=-1, keepdims=True) * self._shares
        return on_arc, on_belt

    def find_flutter(self) -> Flutter | None:
        """The largest growth of vibrations while the belt slid; None where none grows, or the mesh does not travel."""
        return self._flutter.find() if self._flutter else None


def _require_numbers(time: FloatArray, shown: BoolArray, seen: Arrays) -> None:
    """Make sure that all that is seen has a value, but spans whose pulleys the belt has left.

    Raises
    ------
    ConvergenceError
        If something has none.
    """
    for name, values in seen.items():
        if name not in _VALUES_OF_SPANS and not np.isfinite(values.sum()):
            times = time[shown] if name in _OF_SHOWN else time
            first = int(np.argmin(np.isfinite(values.reshape(len(times), -1)).all(axis=1)))
            raise ConvergenceError(
                f"the simulation fails at t = {times[first]:.6g} s: {name} is not finite. Check loads and "
                "stiffnesses for extreme values, or reduce simulation.max_step."
            )

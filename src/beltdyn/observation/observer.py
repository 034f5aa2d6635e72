"""What is seen at successive states of a simulation: there, at ends of steps, the equations of motion hold."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.contact.surface import ToothedRims
from beltdyn.errors import ConvergenceError, SlipError
from beltdyn.model import Prepared
from beltdyn.parts.quantity import RPM
from beltdyn.results.belt_history import mid_span_displacements
from beltdyn.results.checks.creep import SWEEP_REMEDY
from beltdyn.results.friction_work import FrictionWork, MaterialWork, Touch
from beltdyn.results.incidents import JUMPS
from beltdyn.results.mechanics import SpanTension, wraps_of_contact
from beltdyn.results.schema import FILTERED, SPAN_TENSIONS
from beltdyn.results.slip_safety import sliding_of_pulleys
from beltdyn.solvers.flutter import Flutter, FlutterWatch
from beltdyn.solvers.trajectory import Chunk
from beltdyn.system.arc_mesh import recorded_lengths
from beltdyn.system.arrays import BENDING_LOSS, ENERGY_WORKS, STRETCH_LOSS, System
from beltdyn.system.frame import OverTime, Travelling, passed_lengths
from beltdyn.system.meshing import JumpWatch, tooth_coordinates, tooth_forces
from beltdyn.system.moving_center import pulley_speeds
from beltdyn.system.nips import seen_nips
from beltdyn.system.observations import OBSERVED
from beltdyn.system.observe import observe_motion

# The energy account of a run: what goes in, what is stored, what is lost, and whether that adds up


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
        """Closure error in shown states; zero as long as no energy was put in.

        Of k states m are shown. Stored energy E has shape (m,), V of springs and weight (k, 2), works in the order of
        `ENERGY_WORKS` (k, 10); J. The first state of all must be shown.
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


Arrays = dict[str, NDArray[Any]]


class Seen(NamedTuple):
    """What is seen at successive states."""

    at_outputs: Arrays
    """Recorded variables at those states that are shown."""
    for_spectra: Arrays
    """Those that are filtered over all states, at every state."""


WORKS = ("friction_work_on_arc", "friction_work_on_belt")
"""Variables that are seen as integrals from the start on, and recorded as what they grow by."""


_VALUES_OF_SPANS = (*SPAN_TENSIONS, "belt_speed", "mid_span_displacement")
_OF_SHOWN = frozenset(name for name, per in OBSERVED.items() if per.shown)
"""Observations that are there for states that are shown alone."""


class Observer:
    """Sees successive states, and keeps what is summed over all of them."""

    def __init__(self, prepared: Prepared, system: System, belt_coordinate: FloatArray) -> None:
        self._prepared, self._system, self._belt_coordinate = prepared, system, belt_coordinate
        lengths = recorded_lengths(system)
        self._shares = lengths / np.sum(lengths)
        self._friction_work = FrictionWork(prepared, np.outer(lengths, system.contact.weights).ravel(), len(lengths))
        self._material_work = MaterialWork(lengths)
        self._energy = EnergyAccount()
        self._flutter = None if isinstance(system.frame, OverTime) else FlutterWatch(system)
        self._jumps = JumpWatch(system, belt_coordinate) if isinstance(system.rims, ToothedRims) else None

    def see(self, states: Chunk, shown: BoolArray) -> Seen:
        """Recorded variables of the shown states, except coordinates and their rates, and spectra of every state."""
        seen = observe_motion(self._system, states.position, states.velocity, states.forces, shown)
        seen = seen._replace(wrap_angle=wraps_of_contact(self._prepared, seen.pulley_center, seen.wrap_angle))
        touched, centers, places = seen.contact_pulley, seen.pulley_center, seen.contact_position
        aside = mid_span_displacements(self._prepared, centers, places, touched)
        lost = np.abs(seen.friction_force * seen.slip_velocity)
        on_arc, on_belt = self._works(Touch(states.time, centers, places, touched, lost), states, shown)
        potential = np.stack([seen.spring_energy, seen.potential_energy], axis=1)
        stored = seen.kinetic_energy + seen.strain_energy + seen.penalty_energy[shown]
        closure = self._energy.closure(stored, potential, states.work, shown)
        every = seen._asdict() | {"mid_span_displacement": aside}
        _require_numbers(states.time, shown, every)
        if self._flutter:
            self._flutter.take(states.time, states.position, states.velocity, every)
        if self._jumps:
            self._jumps.take(states.time, states.position, centers, places)
        rows = {name: values if name in _OF_SHOWN else values[shown] for name, values in every.items()}
        at_outputs = {
            **rows,
            **sliding_of_pulleys(
                self._prepared,
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
            **self._teeth(states, shown),
            **self._nips(states, shown),
        }
        return Seen(at_outputs, {name: values for name, values in every.items() if name in FILTERED})

    def _teeth(self, states: Chunk, shown: BoolArray) -> Arrays:
        """Forces of single teeth in the states that are shown, if there are any."""
        if not tooth_coordinates(self._system).size:
            return {}
        return {"tooth_force": tooth_forces(self._system, states.position[shown], states.velocity[shown])}

    def _nips(self, states: Chunk, shown: BoolArray) -> Arrays:
        """What is seen in nips in the states that are shown, if there are any."""
        found = seen_nips(self._system, states.position[shown], states.velocity[shown])
        return {} if found is None else found._asdict()

    def _works(self, touch: Touch, states: Chunk, shown: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Work of friction since the beginning by arc and by belt, in the states that are shown.

        Where the belt flows through the mesh, it is spread on what passes in each step, whichever states are shown.
        """
        frame = self._system.frame
        if isinstance(frame, OverTime):
            on_arc, on_mesh = self._friction_work.take(touch, np.ones_like(shown))
            passed = passed_lengths(frame, states.position, len(self._shares))
            return on_arc[shown], self._material_work.take(on_mesh, passed)[shown]
        on_arc, on_belt = self._friction_work.take(touch, shown)
        if not isinstance(frame, Travelling):  # all of the belt passes
            on_belt = np.sum(on_belt, axis=-1, keepdims=True) * self._shares
        return on_arc, on_belt

    def find_flutter(self) -> Flutter | None:
        """The largest growth of vibrations while the belt slid; None where none grows, or the mesh does not travel."""
        return self._flutter.find() if self._flutter else None

    def find_jumps(self) -> dict[str, FloatArray]:
        """Attributes of results that tell where the belt has jumped grooves; none where it has not."""
        events = self._jumps.events if self._jumps else []
        columns = [np.array(column, dtype=float) for column in zip(*events, strict=True)]
        return dict(zip(JUMPS, columns, strict=True)) if events else {}


def _require_numbers(time: FloatArray, shown: BoolArray, seen: Arrays) -> None:
    """Make sure that all that is seen has a value, but spans whose pulleys the belt has left."""
    for name, values in seen.items():
        if name not in _VALUES_OF_SPANS and not np.isfinite(values.sum()):
            times = time[shown] if name in _OF_SHOWN else time
            first = int(np.argmin(np.isfinite(values.reshape(len(times), -1)).all(axis=1)))
            raise ConvergenceError(
                f"the simulation fails at t = {times[first]:.6g} s: {name} is not finite. Check loads and "
                "stiffnesses for extreme values, or reduce simulation.max_step."
            )


# Detection of gross slip, which ends the run: what follows would not be what the drive is for

_FAST = 0.05
"""Velocity of sliding of a whole arc, over the speed of the swept pulley's rim, from which on it counts."""


class SlipThrough:
    """Watches the outputs of a run-up, in which the speed of the pulley `swept` rises."""

    def __init__(self, prepared: Prepared, swept: int) -> None:
        self._prepared, self._swept, self._radius = prepared, swept, float(prepared.radii[swept])
        self._since = np.full(len(prepared.pulleys), np.inf)
        self._load = np.zeros(len(prepared.pulleys))
        self._speed = np.zeros(len(prepared.pulleys))

    def __call__(self, outputs: Arrays) -> None:
        """Look at further outputs."""
        for row, time in enumerate(outputs["time"]):
            sliding = np.abs(outputs["sliding_speed"][row])
            speed = float(outputs["pulley_speed"][row, self._swept])
            rim = abs(speed) * self._radius
            fast = (sliding > _FAST * rim) & ~self._prepared.drive.guides
            begins = fast & np.isinf(self._since)
            self._since = np.where(fast, np.where(begins, time, self._since), np.inf)
            self._load = np.where(begins, np.abs(outputs["pulley_torque"][row]), self._load)
            self._speed = np.where(begins, speed, self._speed)
            for number in np.flatnonzero(time - self._since > self._prepared.belt_length / max(rim, 1e-9)):
                raise SlipError(self._message(int(number), time, speed, outputs, row), SWEEP_REMEDY)

    def _message(self, number: int, time: float, speed: float, outputs: Arrays, row: int) -> str:
        name, swept = (self._prepared.pulleys[one].name for one in (number, self._swept))
        tension = SpanTension.of(lambda name: outputs[name][row])
        before, after = (float(side[number]) for side in tension.at_arcs(self._prepared))
        sliding = abs(float(outputs["sliding_speed"][row, number]))
        share = sliding / (abs(speed) * self._radius)
        return (
            f"the sweep stops at t = {time:.4g} s, {swept} at {RPM * speed:.4g} rpm: {name} is in gross slip. "
            f"Since {RPM * self._speed[number]:.4g} rpm its whole arc has been sliding, now at {sliding:.3g} "
            f"m/s, {share:.0%} of the rim speed of {swept}. At the onset it had to transmit "
            f"{self._load[number]:.4g} N m, more than friction can transmit with the tensions of "
            f"{max(before, after):.4g} and {min(before, after):.4g} N in the adjacent spans."
        )

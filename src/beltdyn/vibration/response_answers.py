"""Amplitudes and phases of results over speed, of each excitation."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.points.operating_points import Axes, labels_of
from beltdyn.results import Run, Variable
from beltdyn.results.mid_span import mid_span_displacements
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe
from beltdyn.vibration.excitation import LOAD, SPEED, Excitation, own_excitations, speed_waves, torque_waves
from beltdyn.vibration.small_motions import about_steady, dry_tensioners

if TYPE_CHECKING:
    from scipy.sparse import csc_array


# Small motions of a drive in steady running under forces and motions that repeat themselves

_SMALL = 1e-6
"""Largest displacement of a node with which results are differenced, over the smallest radius."""
_OBSERVED = ("pulley_torque", "shaft_torque", "hub_force", "span_tension", "belt_speed")


class ForcedMotion:
    """A drive in steady running, which small motions of shafts and small torques on them excite.

    Parameters
    ----------
    run
        From `steady_state`.
    stuck
        Whether dry friction holds tensioners; else it is left out.
    """

    def __init__(self, run: Run, stuck: bool) -> None:
        self._motions = about_steady(run, all_shafts=True)
        held = self._motions.with_stuck(dry_tensioners(run.drive)) if stuck else self._motions
        self._bodies, self._tangents = held.bodies, (held.stiffness, held.damping, held.mass)
        shafts = np.asarray(self._motions.system.pulleys.shaft)
        self._shafts = self._bodies[shafts]
        driven = np.array([one.prescribed for one in run.drive.pulleys])
        self._driven = np.flatnonzero(driven)
        self._free = np.setdiff1d(np.arange(held.stiffness.shape[0]), self._shafts[driven])
        state = self._motions.state
        self._still = self._seen(state.position[None].copy(), state.velocity[None].copy())

    def answer(
        self, frequency: float, angles: Mapping[int, complex], torques: Mapping[int, complex]
    ) -> dict[str, ComplexArray]:
        """Amplitudes of results."""
        from scipy.sparse.linalg import splu

        stiffness, damping, mass = self._tangents
        matrix: csc_array = (stiffness + 1j * frequency * damping - frequency**2 * mass).tocsr()
        moved, load = np.zeros((2, matrix.shape[0]), complex)
        for target, given in ((moved, angles), (load, torques)):
            for pulley, amplitude in given.items():
                target[self._shafts[pulley]] += amplitude
        rows = matrix[self._free]
        moved[self._free] = splu(rows[:, self._free].tocsc()).solve((load - matrix @ moved)[self._free])
        found = self._results(moved, frequency)
        for pulley, amplitude in torques.items():
            found["shaft_torque"][pulley] += amplitude
        found["shaft_torque"][self._driven] = (matrix @ moved)[self._shafts[self._driven]]
        return found

    def _results(self, moved: ComplexArray, frequency: float) -> dict[str, ComplexArray]:
        """Amplitudes of results from those of the unknowns: derivatives of what is observed, along both parts."""
        system = self._motions.system
        position = np.zeros(system.first_body + system.bodies.size, complex)
        position[: system.first_body] = moved[: system.first_body]
        position[system.first_body :] = np.where(self._bodies >= 0, moved[self._bodies], 0.0)
        velocity = 1j * frequency * position
        real = self._derivative(position.real, velocity.real)
        imaginary = self._derivative(position.imag, velocity.imag)
        found = {name: real[name] + 1j * imaginary[name] for name in real}
        ways = position[system.first_body :]
        speeds, pulleys = 1j * frequency * ways, system.pulleys.size
        direction = self._still["hub_force"][0]
        return found | {
            "hub_load": np.sum(found["hub_force"] * direction, axis=1) / np.linalg.norm(direction, axis=1),
            "pulley_speed": speeds[:pulleys],
            "shaft_speed": speeds[np.asarray(system.pulleys.shaft)],
            "tensioner_position": ways[ways.size - system.tensioners.size :],
        }

    def _derivative(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """Change of what is observed with a change of the state."""
        system, state = self._motions.system, self._motions.state
        largest = float(np.max(np.abs(position[: system.first_body]))) or 1.0
        step = _SMALL * float(np.min(system.rims.radius)) / largest
        steps = step * np.array([[1.0], [-1.0]])
        seen = self._seen(state.position + steps * position, state.velocity + steps * velocity)
        return {name: (values[0] - values[1]) / (2.0 * step) for name, values in seen.items()}

    def _seen(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """What is observed at states, a row each."""
        seen: Observations = observe(self._motions.system, np.zeros(len(position)), position, velocity)
        aside = mid_span_displacements(
            self._motions.drive, seen.pulley_center, seen.contact_position, seen.contact_pulley
        )
        return {name: getattr(seen, name) for name in _OBSERVED} | {"mid_span_displacement": aside}


RESPONSES = {
    "span_tension": Variable(("span",), "N", "Span tension"),
    "mid_span_displacement": Variable(("span",), "m", "Mid-span displacement"),
    "belt_speed": Variable(("span",), "m/s", "Belt speed"),
    "pulley_speed": Variable(("pulley",), "rad/s", "Pulley speed"),
    "shaft_speed": Variable(("pulley",), "rad/s", "Shaft speed"),
    "pulley_torque": Variable(("pulley",), "N m", "Torque of the belt on the pulley"),
    "shaft_torque": Variable(("pulley",), "N m", "Shaft torque"),
    "hub_load": Variable(("pulley",), "N", "Hub load"),
    "tensioner_position": Variable(("tensioner",), "m or rad", "Tensioner position"),
}
"""Results whose amplitudes are found, with the dimension that comes after speed and excitation."""
_ABOUT = ("speed", "excitation")


class Answers:
    """Collects responses from speed to speed.

    Parameters
    ----------
    drive
        With the harmonics that excite it, and constant speeds, torques and schedules.
    number
        Number of the pulley whose speed is prescribed.
    speeds : ndarray, shape (n,)
        Its speeds, rad/s.

    Raises
    ------
    ModelError
        If nothing excites it.
    """

    def __init__(self, drive: Drive, number: int, speeds: FloatArray) -> None:
        self._drive, self._speeds, self._labels = drive, speeds, labels_of(drive)
        count = speeds.size
        driven = {number, *(place for place, one in enumerate(drive.pulleys) if one.prescribed)}
        self.excitations = [
            one
            for one in own_excitations(drive)
            if one.cause == SPEED or (one.cause == LOAD and one.pulley not in driven)
        ]
        if not self.excitations:
            raise ModelError(
                "the drive has no excitation: no prescribed speed and no load of a free pulley has harmonics. "
                "Give a pulley `harmonics = [{ order = 2, amplitude = 0.02 }]`, or a load a torque over its "
                "angle."
            )
        known = {name: one for name, one in RESPONSES.items() if self._labels[one.dims[0]]}
        self._variables = known
        self._found: dict[str, ComplexArray] = {
            name: np.full((count, len(self.excitations), len(self._labels[one.dims[0]])), complex(np.nan, np.nan))
            for name, one in known.items()
        }
        self._frequency = np.full((count, len(self.excitations)), np.nan)

    def take(self, row: int, run: Run, motion: ForcedMotion) -> None:
        """Take the responses at a speed."""
        for place, one in enumerate(self.excitations):
            hertz = one.frequency(run)
            speed = float(run.dataset[one.turning][-1, one.pulley])
            backward = speed < 0.0  # the angle falls: exp(i k theta) is exp(-i w t)
            wave = self._wave(one, speed)
            given = {one.pulley: wave.conjugate() if backward else wave}
            angles, torques = (given, {}) if one.cause == SPEED else ({}, given)
            found = motion.answer(2.0 * np.pi * hertz, angles, torques)
            self._frequency[row, place] = hertz
            for name, values in self._found.items():
                values[row, place] = np.conj(found[name]) if backward else found[name]

    def _wave(self, one: Excitation, speed: float) -> complex:
        """Amplitude of an excitation over the angle of its shaft, rad or N m, at a speed of the shaft, rad/s."""
        if one.cause == SPEED:
            return speed_waves(self._drive, one.pulley)[one.order]
        return torque_waves(self._drive, one.pulley, speed).get(one.order, 0.0j)

    @property
    def coordinates(self) -> Axes:
        """Names of the excitations, and their orders."""
        return {
            "excitation": (Variable(("excitation",), "1", "Excitation", "str"), [one.name for one in self.excitations]),
        }

    def variables(self) -> Axes:
        """Amplitudes and phases, and for each span, pulley and tensioner the largest sum of all amplitudes."""
        found: dict[str, tuple[Variable, ArrayLike]] = {
            "order": (
                Variable(("excitation",), "1", "Order, cycles per turn of the exciting shaft"),
                [one.order for one in self.excitations],
            ),
            "excitation_frequency": (
                Variable(("speed", "excitation"), "Hz", "Excitation frequency"),
                self._frequency,
            ),
        }
        for name, one in self._variables.items():
            values, units = self._found[name], self._units(one.units)
            dims = ("speed", "excitation", *one.dims)
            found[f"{name}_amplitude"] = Variable(dims, units, f"{one.long_name}, amplitude"), np.abs(values)
            found[f"{name}_phase"] = Variable(dims, "rad", f"{one.long_name}, phase"), np.angle(values)
        for name, one in self._variables.items():
            total = np.abs(self._found[name]).sum(axis=1)
            label = f"Amplitude of {one.long_name[0].lower()}{one.long_name[1:]}: maximum sum of all orders"
            largest = np.fmax.reduce(total, axis=0)
            found[f"largest_{name}_amplitude"] = Variable(one.dims, self._units(one.units), label), largest
        return found

    def warnings(self, means: Mapping[str, NDArray[Any]]) -> list[str]:
        """Where vibrations are too large for a linear response: where the belt would go slack."""
        total = np.abs(self._found["span_tension"]).sum(axis=1)
        with np.errstate(invalid="ignore"):
            slack = total > means["span_tension"]
        if not slack.any():
            return []
        row, span = np.unravel_index(np.nanargmax(np.where(slack, total / means["span_tension"], 0.0)), slack.shape)
        return [
            f"at {np.count_nonzero(slack.any(axis=1))} speeds spans would go slack; the worst is at "
            f"{RPM * self._speeds[row]:.4g} rpm, where the tension of {self._labels['span'][span]} oscillates "
            f"by up to {total[row, span]:.4g} N about {means['span_tension'][row, span]:.4g} N. The linear "
            "analysis overestimates the amplitudes there. Simulate a run-up with `beltdyn sweep` and add it "
            "with --compare."
        ]

    def _units(self, units: str) -> str:
        """The unit of a result, for tensioners that of those of the drive."""
        turning = {one.turns for one in self._drive.moving_tensioners}
        return ("rad" if turning.pop() else "m") if units == "m or rad" and len(turning) == 1 else units

"""Amplitudes and phases of results over speed, of each excitation."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.results import Run, Variable
from beltdyn.solve.steady_running.operating_points import Axes
from beltdyn.solve.steady_running.point_values import labels_of
from beltdyn.solve.vibration.excitation import LOAD, SPEED, Excitation, own_excitations
from beltdyn.solve.vibration.forced_motion import ForcedMotion
from beltdyn.solve.vibration.waves import speed_waves, torque_waves

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
        """Take the responses at a speed.

        Parameters
        ----------
        row
            Number of the speed.
        run
            Steady running there.
        motion
            Small motions about it.
        """
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
        """Where vibrations are too large for a linear response: where the belt would go slack.

        Parameters
        ----------
        means
            Arrays of the operating points.
        """
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

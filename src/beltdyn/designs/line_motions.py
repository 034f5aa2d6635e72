"""Start, coasting and emergency stop of a belt that moves as a whole: pulls of its drives and brakes, and tensions."""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.kernel import interpreted
from beltdyn.machines import Brake
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.model import Drive
from beltdyn.model.carrying import stretch_of
from beltdyn.results import Run
from beltdyn.system.build_machines import machine_arrays

MOTIONS = ("start", "coasting", "emergency stop")
"""With the torque of the start, without drives, and with all brakes."""
_START, _COASTING, _STOP = range(3)
_SPEEDS = 50
"""At which the torque of a motor is looked at."""


class Launch(NamedTuple):
    """How a line starts and is stopped."""

    rising: float
    """Largest acceleration of the driver in starts, rad/s^2; zero for that of its motor."""
    braking: FloatArray
    """Forces on the belt of the brakes that do not act in steady running, N, shape (pulleys,)."""


def braking_forces(drive: Drive) -> FloatArray:
    """Largest forces of the brakes of each pulley on the belt at any time, N, shape (pulleys,)."""
    torques = [
        sum(load.torque.largest(np.inf) for load in one.load if isinstance(load, Brake)) for one in drive.pulleys
    ]
    return np.array(torques, dtype=np.float64) / np.abs(drive.rolling_radii)


class Motions:
    """A belt that starts, coasts and stops as a whole.

    Every mass takes its part of the tension behind it. Drives share what accelerates the belt as they share the pull in
    steady running. A weight, or another tensioner that moves, keeps its tension; with a fixed one the belt keeps its
    stretch. Resistances are those of steady running. Arrays over motions follow `MOTIONS`.
    """

    def __init__(self, run: Run, ends: FloatArray, launch: Launch) -> None:
        """`ends`: tensions at start and end of each span in running direction, shape (2, spans), N."""
        self.run, self.prepared, self.launch, self.ends = run, run.prepared, launch, ends
        drive = self.drive = run.drive
        self.at = run.dataset.isel(time=-1, field_time=-1)
        self.forward = float(self.at["belt_speed"].values.mean()) >= 0.0
        self.speed = float(np.abs(self.at["belt_speed"].values).mean())
        self.drives = np.array([one.prescribed or any(load.driven_speed for load in one.load) for one in drive.pulleys])
        self.radii = np.abs(self.prepared.rolling_radii)
        # by torques, since tensions at both ends of an arc also differ by the weight of the belt on it
        driving = -np.sign(self.at["pulley_speed"].values) * self.at["pulley_torque"].values
        self.pulls = np.where(self.drives, driving / self.radii, 0.0)
        """Of the drives in steady running, N, shape (pulleys,); negative where goods that go down drive the belt."""
        self.inertia = np.array([one.inertia for one in drive.pulleys]) / self.radii**2
        self.masses = _span_masses(run)
        self.mass = float(np.sum(self.masses) + np.sum(self.inertia[~self.drives]))
        self.driving_mass = float(np.sum(self.inertia[self.drives]))

    @property
    def powered(self) -> BoolArray:
        """Pulleys with a drive or a brake, shape (pulleys,)."""
        return np.asarray(self.drives | (self.launch.braking > 0.0))

    @cached_property
    def accelerations(self) -> FloatArray:
        """Of the belt in its running direction, m/s^2, shape (motions,); not a number of a stop without brakes."""
        mass, pull, braking = self.mass + self.driving_mass, float(np.sum(self.pulls)), float(self.launch.braking.sum())
        stop = -(pull + braking) / mass if braking > 0.0 else np.nan
        return np.array([max(0.0, self._starting_acceleration()), -pull / mass, stop])

    def _starting_acceleration(self) -> float:
        """As asked for at the driver, or what the largest torques of motors give at speeds up to the present one."""
        drive = self.drive
        if self.launch.rising > 0.0 or drive.driver is None or drive.pulleys[drive.driver].prescribed:
            return self.launch.rising * float(self.radii[drive.reference])
        machines = machine_arrays(self.prepared.pulleys, (), self.prepared.path)
        speeds, states = self.at["pulley_speed"].values, np.zeros(self.run.dataset.sizes["body"])
        torque, pull = interpreted(shaft_torque), 0.0
        for p in np.flatnonzero(self.drives):
            given = (
                torque(machines.profiles, machines.shaft_loads, int(p), 0.0, 0.0, part * speeds[p], states).torque
                for part in np.linspace(0.0, 1.0, _SPEEDS)
            )
            pull += max(np.sign(speeds[p]) * one for one in given) / float(self.radii[p])
        return float((pull - np.sum(self.pulls)) / (self.mass + self.driving_mass))

    @cached_property
    def shaft_forces(self) -> FloatArray:
        """Torques of drives and brakes over the radii, N, positive driving, shape (motions, pulleys)."""
        starting = self.pulls_on_belt[_START] + self.drives * self.inertia * self.accelerations[_START]
        stopping = np.where(np.isnan(self.accelerations[_STOP]), np.nan, -self.launch.braking)
        return np.array([starting, np.zeros_like(starting), stopping])

    @cached_property
    def pulls_on_belt(self) -> FloatArray:
        """Pulls of drives and brakes on the belt, without what accelerates them, N, shape (motions, pulleys)."""
        whole = float(np.sum(np.abs(self.pulls)))
        shares = np.abs(self.pulls) / whole if whole > 0.0 else self.drives / np.count_nonzero(self.drives)
        start, coasting, stop = self.accelerations
        rotors = self.drives * self.inertia
        return np.array(
            [
                self.pulls + shares * self.mass * start,
                -rotors * coasting,
                -self.launch.braking - rotors * stop,
            ]
        )

    @cached_property
    def rises(self) -> FloatArray:
        """Tensions at start and end of each span above those in steady running, N, shape (motions, 2, spans)."""
        return np.array([self._rises_in(number) for number in range(len(MOTIONS))])

    def _rises_in(self, motion: int) -> FloatArray:
        acceleration, count = float(self.accelerations[motion]), len(self.pulls)
        idle = acceleration * np.where(self.drives, 0.0, self.inertia)
        taken = idle - (self.pulls_on_belt[motion] - self.pulls)
        first, last, tension = np.zeros(count), np.zeros(count), 0.0
        for step in range(count):
            p = (self.drive.reference + (step if self.forward else -step)) % count
            span = p if self.forward else (p - 1) % count
            tension += float(taken[p])
            first[span] = tension
            tension += acceleration * float(self.masses[span])
            last[span] = tension
        kept = float(np.average(0.5 * (first + last), weights=self.prepared.installation.path.span_lengths))
        if self.drive.moving_tensioners:
            p = self.drive.carried(self.drive.moving_tensioners[0])
            kept = 0.5 * float(first[p] + last[p - 1] if self.forward else first[p - 1] + last[p])
        return np.array([first - kept, last - kept])

    @cached_property
    def tensions(self) -> FloatArray:
        """At start and end of each span in running direction, N, shape (motions, 2, spans)."""
        return np.asarray(self.ends + self.rises)

    @cached_property
    def at_pulleys(self) -> FloatArray:
        """Tensions where the belt reaches and leaves each pulley, N, shape (motions, 2, pulleys)."""
        return np.array([self._at_pulleys(ends) for ends in self.tensions])

    @cached_property
    def running_at_pulleys(self) -> FloatArray:
        """The same in steady running, shape (2, pulleys)."""
        return self._at_pulleys(self.ends)

    def _at_pulleys(self, ends: FloatArray) -> FloatArray:
        numbers = np.arange(len(self.pulls))
        reaching, leaving = (numbers - 1, numbers) if self.forward else (numbers, numbers - 1)
        return np.array([ends[1, reaching], ends[0, leaving]])

    @cached_property
    def tension_ratios(self) -> FloatArray:
        """Tight over slack effective tension T - m v^2 of each pulley, shape (motions, pulleys); infinite if slack."""
        effective = self.at_pulleys - self.prepared.belt.mass_per_length * self.speed**2
        slack, tight = effective.min(axis=1), effective.max(axis=1)
        ratios = np.divide(tight, slack, out=np.full_like(tight, np.inf), where=slack > 0.0)
        return np.where(np.isnan(tight), np.nan, ratios)

    @cached_property
    def slack(self) -> tuple[FloatArray, FloatArray]:
        """Tension behind each drive in a start, and what Euler's formula needs there, N, shape (pulleys,)."""
        needed = np.abs(self.pulls_on_belt[_START]) / np.expm1(self.prepared.frictions * self.at["wrap_angle"].values)
        slack = self.at_pulleys[_START].min(axis=0)
        return np.where(self.drives, slack, np.nan), np.where(self.drives, needed, np.nan)

    def warnings(self, point: str) -> Iterator[str]:
        """What a designer has to look after in starts and stops at an operating point."""
        names = [one.name for one in self.drive.pulleys]
        slack, needed = self.slack
        for number in np.flatnonzero((slack < needed) & (self.accelerations[_START] > 0.0)):
            yield (
                f"{names[number]} slips in starts at operating point {point}: its slack tension is "
                f"{slack[number]:.4g} N, Euler's formula needs {needed[number]:.4g} N. Raise the tension, or start "
                "more slowly."
            )
        allowed = np.exp(self.prepared.frictions * self.at["wrap_angle"].values)
        for number in np.flatnonzero(self.powered & (self.tension_ratios[_STOP] > allowed)):
            yield (
                f"{names[number]} slips in emergency stops at operating point {point}: the ratio of its tensions is "
                f"{self.tension_ratios[_STOP, number]:.3g}, friction allows {allowed[number]:.3g}. Raise the tension, "
                "or brake more gently, or on another drum."
            )
        if self.accelerations[_COASTING] > 0.0:
            stop = self.accelerations[_STOP]
            brakes = "Give a brake" if np.isnan(stop) else "The brakes are too weak for it"
            yield (
                f"goods that go down drive the belt at operating point {point}: without drives it speeds up by "
                f"{self.accelerations[_COASTING]:.3g} m/s². {'The brakes stop it' if stop < 0.0 else brakes}."
            )
        for motion, ends in zip(MOTIONS, self.tensions, strict=True):
            if ends.min() < 0.0:  # not of a stop without brakes, whose tensions are not numbers
                span = int(np.argmin(ends.min(axis=0)))
                yield (
                    f"the span {'-'.join(self.drive.spans[span])} goes slack in the motion {motion} at operating point "
                    f"{point}: its tension would be {float(ends[:, span].min()):.4g} N. Raise the tension, or start "
                    "and brake more gently."
                )


def _span_masses(run: Run) -> FloatArray:
    """Mass that moves with each span, kg, of belt, goods and idlers; half of the arcs at either end counts to it."""
    drive, prepared, path = run.drive, run.prepared, run.prepared.installation.path
    around = np.abs(path.radii) * path.wrap_angles
    lengths = np.asarray(path.span_lengths) + 0.5 * (around + np.roll(around, -1))
    masses = lengths / float(np.sum(lengths)) * prepared.belt.mass_per_length * prepared.belt_length
    for one in drive.goods:
        place = stretch_of(one, drive.spans, path)
        masses[place.span] += one.mass_per_length * place.length
    for support in drive.supports:
        place = stretch_of(support, drive.spans, path)
        masses[place.span] += support.rotating_mass * place.length
    return np.asarray(masses)

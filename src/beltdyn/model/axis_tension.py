"""Tension at rest that the moves of a linear axis require, so that no span becomes slack anywhere on the stroke.

A force on the carriage divides between both ways to the driver as the stiffnesses of their spans do: next to a pulley
the short span carries nearly all of it.  The carriage answers each change of the acceleration by a vibration on its
spans: a jump doubles the force, a limited jerk adds little (Duhamel's integral).
"""

from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.belt_loads import RequiredTension
from beltdyn.model.drive import Drive
from beltdyn.model.end import Carriage, carriage_rate, range_of
from beltdyn.model.path import Path

OF_AXES = "axis, with a tenth of the pull in the slack span"
"""The rule of linear axes; that of makers, at least the pull, is the same next to a pulley but for the tenth."""
_RESERVE = 0.1
"""Part of the pull that remains in the slack span, as in the rule for toothed belts."""
_SHORTEST = 1e-3
"""Least length of a way to the driver over that of both: a clamp at a pulley has no span."""
_PLACES = 5
"""Places over the stroke at which forces are looked at."""
_PER_PERIOD = 20
"""Instants in a period of the carriage on its belt, at which an error of the largest force is below 1 %."""
_MIN_INSTANTS, _MAX_INSTANTS = 2001, 400_001
"""Instants of the moves; a run of 20 s at 1 kHz has the most."""


class _Moves(NamedTuple):
    """Moves of a carriage without vibration."""

    times: FloatArray
    """s, evenly spaced."""
    speed: FloatArray
    """m/s."""
    acceleration: FloatArray
    """m/s²."""
    force: FloatArray
    """On the carriage from outside, N."""


def axis_tension(drive: Drive, path: Path, tension: float) -> RequiredTension | None:
    """The tension at rest that the moves require, N; None without a carriage or a prescribed speed.

    Spans have their stiffness at a tension (N).
    """
    carriage = drive.carriage
    driver = next((number for number, one in enumerate(drive.pulleys) if one.speed is not None), None)
    if carriage is None or driver is None:
        return None
    belt = drive.completed.belt
    ways = np.linspace(*range_of(carriage, path, drive.pulleys, drive.simulation.end), _PLACES)
    lengths = _ways_to_driver(path, driver) + np.array([[-1.0], [1.0]]) * _sense(drive, path) * ways
    total = float(lengths[:, 0].sum())
    lengths = np.maximum(lengths, _SHORTEST * total)
    mass = carriage.mass + belt.mass_per_length * total
    stiffness = belt.local_stiffness(tension) * total / (lengths[0] * lengths[1])
    frequencies = np.sqrt(stiffness / mass) / (2.0 * pi)
    share = lengths.max(axis=0) / total  # of the force, on the shorter way
    moves = _moves(drive, path, driver, float(frequencies.max()))
    damping = damping_ratio(belt, carriage, frequencies, 1.0 / mass)
    pulls = [
        _largest(mass * moves.acceleration - moves.force, moves, carriage.friction, carriage.damping, frequency, ratio)
        for frequency, ratio in zip(frequencies.tolist(), np.minimum(damping, 0.9).tolist(), strict=True)
    ]
    pull = float(max(pulls))
    if not pull > 0.0:
        return None
    needed = float(np.max(share * pulls)) + _RESERVE * pull
    words = f"{pull:.4g} N: {mass:.4g} kg at up to {np.abs(moves.acceleration).max():.4g} m/s²"
    words += f", with its vibration{' and friction' * bool(carriage.friction or carriage.damping)}"
    return RequiredTension(pull, {OF_AXES: needed}, words)


def damping_ratio(belt: Belt, carriage: Carriage, frequency: ArrayLike, mobility: float) -> FloatArray:
    """Damping ratio of a carriage that vibrates on its belt at a frequency (Hz), by losses of belt and guide.

    `mobility` is the square of its way in the mode of unit mass, 1/kg.
    """
    hertz = np.asarray(frequency, dtype=float)
    by_belt = 0.5 * belt.stretch_loss_factor + pi * hertz * belt.stretch_damping_time
    return np.asarray(by_belt + carriage.damping * mobility / (4.0 * pi * hertz))


def _ways_to_driver(path: Path, driver: int) -> FloatArray:
    """Lengths of the spans from both clamps to the driver, "out" and "in", shape (2, 1), m."""
    lengths = np.asarray(path.span_lengths, dtype=float)
    inner, last, first = lengths[:-2], lengths[-2], lengths[-1]
    return np.array([[first + inner[:driver].sum()], [last + inner[driver:].sum()]])


def _sense(drive: Drive, path: Path) -> float:
    """By how much the way from the clamp "out" becomes shorter for a way of the carriage along its direction."""
    assert drive.carriage is not None
    return -float(np.sign(np.dot(path.ways_out[0], drive.carriage.direction)))


def _moves(drive: Drive, path: Path, driver: int, frequency: float) -> _Moves:
    """What a driver makes of a carriage on an unstretched belt, resolving a frequency (Hz)."""
    carriage, begin, end = drive.carriage, drive.simulation.begin, drive.simulation.end
    assert carriage is not None
    count = int(np.clip(_PER_PERIOD * frequency * (end - begin), _MIN_INSTANTS, _MAX_INSTANTS))
    times = np.linspace(begin, end, count)
    profile = drive.pulleys[driver].speed
    assert profile is not None
    speed = carriage_rate(carriage, path, driver) * profile.at(times)
    acceleration = np.gradient(speed, times)
    force = np.zeros(count) if carriage.force is None else carriage.force.at(times)
    gravity = float(np.dot(drive.gravity, carriage.direction))
    return _Moves(times, speed, acceleration, force + carriage.mass * gravity)


def _largest(
    forces: FloatArray, moves: _Moves, friction: float, damping: float, frequency: float, ratio: float
) -> float:
    """Largest force of the belt on the carriage, N, that vibrates at a frequency (Hz) with a damping ratio."""
    from scipy.signal import lfilter

    step, omega = float(moves.times[1] - moves.times[0]), 2.0 * pi * frequency
    root = sqrt(1.0 - ratio * ratio)
    pole = np.exp((-ratio + 1j * root) * omega * step)
    held = forces[0]  # it pulls before the moves, and excites nothing
    answer = lfilter([omega * step / root], [1.0, -pole], forces - held).imag + held
    against = friction * np.sign(np.round(moves.speed, 9)) + damping * moves.speed
    return float(np.abs(answer + against).max())

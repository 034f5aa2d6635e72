"""Profiles as kernels see them: value, rate, integral and next kink at an instant (Eqs. 28 and 29)."""

from collections.abc import Sequence
from math import nextafter, sin
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, Records, offsets, record, records
from beltdyn.kernel import interpreted, kernel
from beltdyn.machines.profiles.harmonic import Harmonic, harmonic_factor, harmonic_rows
from beltdyn.machines.profiles.profile import SEGMENT, Profile, segment_integral, segment_value

NO_SCHEDULE = -1
"""Number of a missing profile."""

PROFILE = record(
    segment="i8",  # its first segment; the last is that before the first of the next row
    harmonic="i8",  # its first harmonic, alike
)
"""A function of time."""

_NOTHING = records(SEGMENT, start=[-np.inf])
"""Segments of a profile that is zero."""


class Profiles(NamedTuple):
    """Functions of time: one of each pulley (speed if prescribed, torque if free, zero if none), then schedules."""

    table: Records
    """Rows of `PROFILE`, one more than there are profiles."""
    segment: Records
    """Rows of `SEGMENT`."""
    harmonic: Records
    """Rows of `HARMONIC`."""


def profile_rows(profiles: Sequence[Profile | None], harmonics: Sequence[Sequence[Harmonic]]) -> Profiles:
    """Profiles, concatenated."""
    pieces = [_NOTHING if profile is None else profile.integrated for profile in profiles]
    first, waves = harmonic_rows(harmonics)
    return Profiles(
        table=records(PROFILE, segment=offsets(map(len, pieces)), harmonic=first),
        segment=np.concatenate([records(SEGMENT, start=[]), *pieces]).view(np.recarray),
        harmonic=waves,
    )


@kernel
def profile_value(profiles: Profiles, number: int, time: float) -> tuple[float, float]:
    """Value of a profile and its rate, without harmonics.

    `time`: s. Returns value, rate: speed and angular acceleration (rad/s, rad/s^2), torque and its rate (N m, N m/s),
    or factor and rate (1/s).
    """
    segment = profiles.segment[_segment(profiles, number, time)]
    since = time - segment.start if segment.slope != 0.0 or segment.curvature != 0.0 else 0.0
    wave_rate = segment.amplitude * segment.frequency * sin(segment.frequency * time + segment.phase)
    return segment_value(segment, since, time), segment.slope + segment.curvature * since - wave_rate


@kernel(inline=True)
def schedule_value(profiles: Profiles, number: int, time: float) -> float:
    """Factor of a schedule at an instant (s), or 1 for `NO_SCHEDULE`."""
    return profile_value(profiles, number, time)[0] if number >= 0 else 1.0


@kernel(inline=True)
def command_value(profiles: Profiles, number: int, time: float) -> float:
    """Value of a command at an instant (s), or 0 for `NO_SCHEDULE`."""
    return profile_value(profiles, number, time)[0] if number >= 0 else 0.0


@kernel
def after_jump(time: float) -> float:
    """The next floating-point number after an instant (s), where a jump at the instant has happened."""
    return nextafter(time, np.inf)


@kernel
def profile_integral(profiles: Profiles, number: int, time: float) -> float:
    """Integral of a profile from time zero, without harmonics: the angle of a mean speed.

    `time`: s. Returns rad, where the profile is a speed.
    """
    k = _segment(profiles, number, time)
    begin = profiles.segment[k].start if k > profiles.table[number].segment else 0.0
    return float(profiles.segment[k].integral + segment_integral(profiles.segment[k], begin, time))


def go_on(profiles: Profiles, numbers: Sequence[int], time: float, values: Sequence[float]) -> None:
    """Continue integrals from given values at a time, as for angles of prescribed speeds."""
    for number, value in zip(numbers, values, strict=True):
        rows = slice(profiles.table[number].segment, profiles.table[number + 1].segment)
        profiles.segment.integral[rows] += value - interpreted(profile_integral)(profiles, number, time)


@kernel
def profile_bend(profiles: Profiles, number: int, time: float) -> tuple[float, float]:
    """The next kink of a profile, and the angular frequency of its wave until then.

    `profiles`: the profiles; harmonics are left out; `time`: s. Returns kink, frequency: s, infinite after the last
    kink; rad/s, zero where the profile is straight.
    """
    k = _segment(profiles, number, after_jump(time))
    last = k + 1 == profiles.table[number + 1].segment
    segment = profiles.segment[k]
    frequency = abs(segment.frequency) if segment.amplitude != 0.0 else 0.0
    return np.inf if last else profiles.segment[k + 1].start, frequency


@kernel
def prescribed_motion(profiles: Profiles, number: int, time: float) -> tuple[float, float, float]:
    """Prescribed speed with its harmonics: omega = m (1 + sum a_k cos(k theta + phi_k)), theta the integral of m.

    `profiles`: the profiles; the value is the mean speed m; `time`: s. Returns angle, speed, acceleration: rad since
    time zero, rad/s, rad/s^2.
    """
    mean, rate = profile_value(profiles, number, time)
    angle = profile_integral(profiles, number, time)
    first, end = profiles.table[number].harmonic, profiles.table[number + 1].harmonic
    turned = angle
    for h in range(first, end):
        wave = profiles.harmonic[h]
        turned += wave.amplitude / wave.order * (sin(wave.order * angle + wave.phase) - sin(wave.phase))
    factor, change = harmonic_factor(profiles.harmonic, first, end, angle)
    return turned, mean * factor, rate * factor + mean * mean * change


@kernel(inline=True)
def _segment(profiles: Profiles, number: int, time: float) -> int:
    """Segment that holds at an instant."""
    first, last = profiles.table[number].segment, profiles.table[number + 1].segment - 1
    while first < last:
        middle = (first + last + 1) // 2
        if profiles.segment[middle].start < time:
            first = middle
        else:
            last = middle - 1
    return int(first)


# Search in a table


@kernel
def first_above(numbers: FloatArray, first: int, end: int, value: float) -> int:
    """Index of the first of ascending numbers above a value.

    `numbers`: shape (n,); `first`, `end`: places of the first number to be looked at, and behind the last. Returns the
    place, `end` where none is above.
    """
    while first < end:
        middle = (first + end) // 2
        if numbers[middle] > value:
            end = middle
        else:
            first = middle + 1
    return first

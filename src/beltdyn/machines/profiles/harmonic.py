"""Harmonics over the angle of a shaft: the factor 1 + sum a_k cos(k theta + phi_k)."""

from collections.abc import Mapping, Sequence
from math import cos, sin, tau
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator, ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import FloatArray, IntArray, Records, offsets, record, records
from beltdyn.kernel import kernel
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Angle, AngularSpeed, Ratio
from beltdyn.parts.table_file import check_points, describe_file, take_file

HARMONIC = record(
    order="f8",  # over an angle
    amplitude="f8",  # over the value
    phase="f8",  # rad
)
"""A harmonic of a speed or of a torque."""


class Harmonic(Part):
    """A harmonic over the shaft angle theta: amplitude cos(order theta + phase).

    Examples
    --------
    >>> bd.model.Harmonic(order=2, amplitude=0.01).order
    2.0
    """

    order: Ratio = Field(gt=0, description="the number of waves per turn of the shaft, such as 2 or 0.5")
    amplitude: Ratio = Field(description="the amplitude over the value without harmonics")
    phase: Angle = Field(0.0, description="the phase at angle zero, in rad")

    def reversed(self) -> Self:
        """The same wave over the opposite angle."""
        return self.replace(phase=-self.phase)


def harmonic_rows(groups: Sequence[Sequence[Harmonic]]) -> tuple[IntArray, Records]:
    """Harmonics of n speeds or torques, concatenated: the first row of each, shape (n + 1,), and rows of `HARMONIC`."""
    found = [item for group in groups for item in group]
    table = records(
        HARMONIC,
        order=[item.order for item in found],
        amplitude=[item.amplitude for item in found],
        phase=[item.phase for item in found],
    )
    return offsets(len(group) for group in groups), table


@kernel(inline=True)
def harmonic_factor(harmonics: Records, first: int, end: int, angle: float) -> tuple[float, float]:
    """1 + sum a_k cos(k theta + phi_k), and its derivative with respect to theta.

    `harmonics`: rows of `HARMONIC`; `first`, `end`: the first one, and that after the last; `angle`: theta, rad.
    """
    factor, change = 1.0, 0.0
    for h in range(first, end):
        wave = harmonics[h]
        factor += wave.amplitude * cos(wave.order * angle + wave.phase)
        change -= wave.amplitude * wave.order * sin(wave.order * angle + wave.phase)
    return factor, change


# Harmonics of a speed measured over the crank angle

_FINE = 16
"""Places in the mean distance between measured points at which the speed is integrated."""
_LEAST = 1e-3
"""Harmonics below this part of the largest are noise."""


class CrankSpeed(Part):
    """A measured speed over the crank angle, periodic; only its ratio to the mean is used.

    The points are `angles` and `speeds`, or the two columns of the CSV file `file`.
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("angles", "speeds"), "two columns, angles and speeds")
    )

    angles: tuple[Angle, ...] = Field(min_length=4, description="the angles of the points within one cycle, in rad")
    speeds: tuple[AngularSpeed, ...] = Field(min_length=4, description="the speeds at these angles, in rad/s")
    cycle: Angle = Field(tau, gt=0, description="the period of the speed, in rad; 4 pi for a four-stroke engine")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "angles", "speeds")

    @model_validator(mode="after")
    def _turns_one_way(self) -> Self:
        check_points("angles", self.angles, "speeds", self.speeds)
        if min(self.speeds) * max(self.speeds) <= 0.0:
            raise ValueError(
                f"speeds range from {min(self.speeds):g} to {max(self.speeds):g} rad/s: a crank that stops or reverses "
                "has no speed over its angle. Give the speed over time, as a profile"
            )
        whole = self.angles[-1] - self.angles[0]
        if whole >= self.cycle * (1.0 + _SAME):
            raise ValueError(f"angles span {whole:g} rad, more than cycle = {self.cycle:g} rad. Give one cycle")
        return self

    def harmonics(self) -> tuple[Harmonic, ...]:
        """Harmonics over the angle of the mean speed, down to a thousandth of the largest, longest wave first."""
        ratio = self._over_mean_angle()
        spectrum = 2.0 * np.fft.rfft(ratio)[1 : (ratio.size + 1) // 2] / ratio.size
        amplitudes, phases = np.abs(spectrum), np.angle(spectrum)
        return tuple(
            Harmonic(order=number * tau / self.cycle, amplitude=float(amplitude), phase=float(phase))
            for number, (amplitude, phase) in enumerate(zip(amplitudes, phases, strict=True), 1)
            if amplitude > max(_LEAST * amplitudes.max(), _NOISE)
        )

    @np.errstate(under="ignore")  # far from a point splines of many points fall below the least number
    def _over_mean_angle(self) -> FloatArray:
        """Speed over its mean at equal steps of the angle of the mean speed, as many as there are points."""
        from scipy.interpolate import CubicSpline  # takes 0.3 s, and most drives have no such table

        angles, speeds = np.array(self.angles), np.array(self.speeds)
        if angles[-1] - angles[0] > self.cycle * (1.0 - _SAME):
            angles, speeds = angles[:-1], speeds[:-1]
        closed = CubicSpline(
            np.append(angles, angles[0] + self.cycle), np.append(speeds, speeds[0]), bc_type="periodic"
        )
        fine = np.linspace(0.0, self.cycle, _FINE * angles.size + 1)
        time = CubicSpline(fine, 1.0 / closed(fine), bc_type="periodic").antiderivative()(fine)
        equal = np.linspace(0.0, time[-1], angles.size, endpoint=False)
        return np.asarray(closed(CubicSpline(time, fine)(equal)) * time[-1] / self.cycle)


_SAME = 1e-6
"""What differs by this part or less is the same."""
_NOISE = 1e-9
"""Rounding."""


_OF_A_CRANK = frozenset({"file", *CrankSpeed.model_fields})
"""Keys of a measured speed, not of a harmonic."""


def _measured(value: Any, info: ValidationInfo) -> Any:
    """Harmonics of a measured speed; what is no such table as it is."""
    if not isinstance(value, CrankSpeed) and not (isinstance(value, Mapping) and _OF_A_CRANK & value.keys()):
        return value
    return CrankSpeed.model_validate(value, context=info.context).harmonics()


SpeedHarmonics = Annotated[
    tuple[Harmonic, ...], BeforeValidator(_measured, json_schema_input_type=tuple[Harmonic, ...] | CrankSpeed)
]
"""Harmonics of a speed, or the table of a measured speed."""

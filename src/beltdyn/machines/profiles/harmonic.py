"""Harmonics over the angle of a shaft: the factor 1 + sum a_k cos(k theta + phi_k)."""

from collections.abc import Sequence
from math import cos, sin

from pydantic import Field

from beltdyn.arrays import IntArray
from beltdyn.kernel import kernel
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Angle, Ratio
from beltdyn.records import Records, offsets, record, records

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
    >>> bd.Harmonic(order=2, amplitude=0.01).order
    2.0
    """

    order: Ratio = Field(gt=0, description="the number of waves per turn of the shaft, such as 2 or 0.5")
    amplitude: Ratio = Field(description="the amplitude over the value without harmonics")
    phase: Angle = Field(0.0, description="the phase at angle zero, in rad")


def harmonic_rows(groups: Sequence[Sequence[Harmonic]]) -> tuple[IntArray, Records]:
    """Harmonics, concatenated.

    Parameters
    ----------
    groups
        Harmonics of each of n speeds or torques.

    Returns
    -------
    first : ndarray, shape (n + 1,)
        The first of each group, and their number.
    harmonics : recarray
        Rows of `HARMONIC`.
    """
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

    Parameters
    ----------
    harmonics
        Rows of `HARMONIC`.
    first, end
        The first one, and that after the last.
    angle
        theta, rad.
    """
    factor, change = 1.0, 0.0
    for h in range(first, end):
        wave = harmonics[h]
        factor += wave.amplitude * cos(wave.order * angle + wave.phase)
        change -= wave.amplitude * wave.order * sin(wave.order * angle + wave.phase)
    return factor, change

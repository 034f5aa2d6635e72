"""Flutter of a sliding belt: friction couples the normal force with longitudinal waves.

On an arc let w be the displacement outwards and u that along the belt, both as exp(i q x + s t).  The belt stretches by
u' + w / R, presses less by k_p w + c_p dw/dt, and where it slides friction is mu times that, whatever u does:

    (m s^2 + c_p s + k_p + EA / R^2) w + i q EA / R u = 0
    (m s^2 + EA q^2) u - (i q EA / R - mu (k_p + c_p s)) w = 0

Waves of stretch in tune with the belt on its penalty springs, q sqrt(EA / m) = sqrt(k_p / m), take energy from what
drives the pulley, like the coupled modes of brakes that squeal.  Where the belt creeps, friction damps them.  Bending
and the belt's own tension are left out.
"""

from typing import NamedTuple

import numpy as np

_SHORTEST = 20.0
"""Largest wave number considered, over that of the tuned waves."""
_WAVES = 4000


class Flutter(NamedTuple):
    """A wave that grows like exp(rate t)."""

    rate: float
    """1/s; negative if it decays."""
    frequency: float
    """Hz."""
    wave_number: float
    """q, 1/m."""


class SlidingBelt(NamedTuple):
    """A belt sliding on a pulley of radius R."""

    mass_per_length: float
    """m, kg/m."""
    axial_stiffness: float
    """EA, N: the rate dN/dg of the law of stretch at the tension of the belt."""
    radius: float
    """R, m."""
    stiffness: float
    """k_p, N/m^2."""
    damping: float
    """c_p, N s/m^2."""
    friction: float
    """mu."""


def flutter_at(belt: SlidingBelt, wave_number: float) -> Flutter:
    """The wave of a wave number q (1/m) that grows fastest, running either way."""
    axial, radius = belt.axial_stiffness, belt.radius
    radial = np.array([belt.mass_per_length, belt.damping, belt.stiffness + axial / radius**2])
    along = np.array([belt.mass_per_length, 0.0, axial * wave_number**2])
    stretch = 1j * wave_number * axial / radius
    rubbing = np.array([0.0, -belt.friction * belt.damping, -belt.friction * belt.stiffness])
    coupling = np.convolve([0.0, 0.0, stretch], rubbing + np.array([0.0, 0.0, stretch]))
    roots = np.roots(np.convolve(radial, along) + coupling)
    fastest = roots[np.argmax(roots.real)]
    return Flutter(float(fastest.real), float(abs(fastest.imag)) / (2.0 * np.pi), wave_number)


def fastest_flutter(belt: SlidingBelt) -> Flutter:
    """The fastest growing wave on an infinite arc, a bound for partly sliding arcs."""
    in_tune = np.sqrt(belt.stiffness / belt.axial_stiffness)
    waves = in_tune * np.linspace(0.0, _SHORTEST, _WAVES + 1)[1:]
    return max((flutter_at(belt, float(wave)) for wave in waves), key=lambda flutter: flutter.rate)

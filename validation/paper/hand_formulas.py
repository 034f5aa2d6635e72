"""Formulas on one line of paper, to compare simulations with."""

from dataclasses import dataclass
from math import pi, tanh

import numpy as np

from beltdyn.model import Drive, install
from beltdyn.theory.creep import capstan_ratio

_ROUNDS = 100


@dataclass(frozen=True, slots=True)
class Swing:
    """Free torsional oscillation of the driven pulley of a two-pulley drive.

    Attributes
    ----------
    frequency : float
        Hz.
    decay : float
        Decay rate of the amplitude, 1/s.
    """

    frequency: float
    decay: float


def torsional_swing(drive: Drive) -> Swing:
    """Swing of the driven pulley on two spans that are held at the tangent points.

    From I theta'' + 2 k R^2 theta = 0 with the stiffness k = E A alpha1 / L of a span of length L.

    Parameters
    ----------
    drive : Drive
        Two pulleys, the second one free.
    """
    return Swing(float(_span_frequency(drive, complex(drive.path.span_lengths[0])).real) / (2.0 * pi), 0.0)


def creeping_torsional_swing(drive: Drive) -> Swing:
    """The same swing when the belt creeps on its pulleys.

    On an arc of length a the slip w follows B w'' = i omega nu_s w, symmetric about the middle of the arc, so that each
    of the two ends of a span is longer by (E A / B) coth(lambda a / 2) / lambda with lambda = sqrt(i omega nu_s / B):
    stretch reaches into the arc, and creep damps.  1 / B = 1 / E A + 1 / R^2 k_p, since a taut belt sinks in by
    T / R k_p, which shortens its arc.  The complex frequency is found by iteration.

    Parameters
    ----------
    drive : Drive
        Two pulleys, the second one free; friction by creep-rate factor.
    """
    factor = drive.contact.creep_rate_factor
    assert factor is not None
    length, stiffness = complex(drive.path.span_lengths[0]), drive.belt.axial_stiffness
    omega = _span_frequency(drive, length)
    for _ in range(_ROUNDS):
        longer = length
        for radius, angle in zip(drive.radii, drive.path.wrap_angles, strict=True):
            sinking = 1.0 + stiffness / (radius**2 * drive.contact_stiffness)
            depth = np.sqrt(1j * omega * factor * sinking / stiffness)
            longer += sinking / (depth * np.tanh(0.5 * depth * angle * radius))
        omega = 0.5 * (omega + _span_frequency(drive, longer))
    return Swing(float(omega.real) / (2.0 * pi), float(omega.imag))


def _span_frequency(drive: Drive, length: complex) -> complex:
    """Circular frequency on two spans of a length, 1/s."""
    radius, inertia = float(drive.radii[1]), drive.pulleys[1].inertia
    return complex(np.sqrt(2.0 * drive.belt.axial_stiffness * radius**2 / (inertia * length)))


def creep_lag(drive: Drive, torque: float, speed: float) -> float:
    """Speed by which the second of two equal pulleys lags behind the first under a torque, rad/s.

    The belt runs at c (1 + T / E A) and changes its tension over an arc of length a by the friction nu_s v_t, so that
    the slip v_t grows along the arc by exp(a nu_s c / E A).  With the difference of tension M / R between the spans,

        lag = omega M / (R E A) coth(a nu_s c / (2 E A)),   c = omega R,

    which is 2 M / (R^2 a nu_s) for small nu_s and elastic creep, omega M / (R E A), for large.

    Parameters
    ----------
    drive : Drive
        Two equal pulleys; friction by creep-rate factor.
    torque : float
        M, what the second pulley takes, N m.
    speed : float
        omega of the pulleys, rad/s.
    """
    factor, radius = drive.contact.creep_rate_factor, float(drive.radii[0])
    assert factor is not None
    stiffness = drive.belt.axial_stiffness
    arc = radius * float(drive.path.wrap_angles[0])
    return speed * torque / (radius * stiffness) / tanh(0.5 * arc * factor * speed * radius / stiffness)


def gross_slip_torque(drive: Drive) -> float:
    """Torque at which the belt slides on the second pulley, by Euler's formula, N m.

    With the sum of the two tensions twice the installed one, 2 T R (exp(mu phi) - 1) / (exp(mu phi) + 1).

    Parameters
    ----------
    drive : Drive
        Two pulleys.
    """
    grip = capstan_ratio(float(drive.frictions[1]), float(drive.path.wrap_angles[1]))
    return 2.0 * install(drive).tension * float(drive.radii[1]) * (grip - 1.0) / (grip + 1.0)

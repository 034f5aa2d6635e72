"""Lowest frequency of a slightly sagging span (Irvine and Caughey 1974), with bending stiffness.

A parabola between ends that hold it is stretched as it swings, since it sags.  With the weight w per length across it

    lambda^2 = (w l / T)^2 l EA / (T L),        L = l (1 + (w l / T)^2 / 8),
    tan(k / 2) = k / 2 - 4 / lambda^2 (k / 2)^3,        omega^2 = (T + EI (k / l)^2) (k / l)^2 / m,

where k, the first root, belongs to the symmetric swing: pi without sag, and up to 3 pi.  The antisymmetric one,
k = 2 pi, does not stretch the span, and is the lowest from lambda = 2 pi on.
"""

from math import cos, pi, sin, sqrt

_SMALLEST = 1e-12
"""lambda^2 below which a span is straight."""


def sag_parameter(weight: float, length: float, tension: float, axial_stiffness: float) -> float:
    """Irvine's parameter lambda^2 for the stiffening by sag, 1."""
    sag = weight * length / tension
    return sag**2 * axial_stiffness / (tension * (1.0 + sag**2 / 8.0))


def lowest_frequency(
    length: float, tension: float, mass: float, *, bending: float = 0.0, sag_parameter: float = 0.0
) -> float:
    """Lowest frequency of transverse vibration of a span in its plane, Hz."""
    wave = min(symmetric_root(sag_parameter), 2.0 * pi) / length
    return wave * sqrt((tension + bending * wave**2) / mass) / (2.0 * pi)


def symmetric_root(sag_parameter: float) -> float:
    """First root k of the symmetric swing, between pi and 3 pi, by bisection."""
    if sag_parameter < _SMALLEST:
        return pi
    low, high = 0.5 * pi, 1.5 * pi
    for _ in range(60):
        half = 0.5 * (low + high)
        excess = sin(half) - (half - 4.0 / sag_parameter * half**3) * cos(half)
        low, high = (half, high) if excess > 0.0 else (low, half)
    return low + high

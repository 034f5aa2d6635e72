"""Rate-independent hysteresis: a stress against the strain rate, in proportion to the strain.

Of a strain x with the rate dx/dt and the modulus c (N, or N m^2) the stress is

    c |x| dx/dt / sqrt((dx/dt)^2 + (w x)^2),    w^2 = (v^2 + v_0^2) / l^2,

after Reid (1956), who has the sign of the rate: rates far above w |x| meet c |x|, whatever the rate; slower ones are
damped in proportion.  v is the speed of the belt and l a length over which strains change on the way of the belt.
The power is never negative.  The paper has no damping of the belt's material.
"""

from math import sqrt
from typing import Final, NamedTuple

from beltdyn.kernel import kernel

CREEPING: Final = 0.1
"""v_0: belt speed below which hysteresis becomes viscous damping, m/s."""


class Hysteretic(NamedTuple):
    """A stress by hysteresis and its derivatives."""

    stress: float
    """N, or N m."""
    by_strain: float
    by_rate: float
    by_square: float
    """By the square of the belt's speed."""


@kernel(inline=True)
def hysteretic(modulus: float, strain: float, rate: float, square: float, length: float) -> Hysteretic:
    """Stress of rate-independent damping (Reid 1956), smoothed at slow rates.

    Parameters
    ----------
    modulus
        c, N or N m^2.
    strain, rate
        x, and dx/dt (1/s times the unit of x).
    square
        v^2, m^2/s^2.
    length
        l, m.

    Returns
    -------
    Hysteretic
    """
    if modulus == 0.0:
        return Hysteretic(0.0, 0.0, 0.0, 0.0)
    passing = square + CREEPING * CREEPING
    slow = passing / (length * length)
    root = sqrt(rate * rate + slow * strain * strain)
    if root == 0.0:
        return Hysteretic(0.0, 0.0, 0.0, 0.0)
    size, sign = abs(strain), 1.0 if strain >= 0.0 else -1.0
    share = rate / root
    fast = share * share
    return Hysteretic(
        modulus * size * share,
        modulus * sign * share * fast,
        modulus * size / root * (1.0 - fast),
        -0.5 * modulus * size * share * (1.0 - fast) / passing,
    )

"""Rolling resistance: the compression loss of the belt on a pulley, distributed over the arc.

A belt that is pressed in meets a larger pressure as it goes in than as it comes out.  The resultant of that difference
holds the belt back and goes through the shaft, so that it does not turn the pulley.  Along the arc it is a share rho of
the normal force against the motion of the belt past the shaft,

    f_r = -rho f_n v_t / sqrt(v_t^2 + v_0^2),

whatever the speed, but for the slowest.  Its power is never positive.  The paper has no such loss.
"""

from math import sqrt
from typing import Final, NamedTuple

from beltdyn.kernel import kernel

CREEPING: Final = 0.01
"""v_0: belt speed below which rolling resistance vanishes smoothly, m/s."""


class RollingResistance(NamedTuple):
    """Rolling resistance at a point and its derivatives."""

    force: float
    """f_r on the belt along t, N/m."""
    by_normal: float
    """df_r / df_n."""
    by_velocity: float
    """df_r / dv_t, N s/m^2."""


@kernel
def rolling_resistance(coefficient: float, normal: float, velocity: float) -> RollingResistance:
    """Rolling resistance at a point of the belt.

    Parameters
    ----------
    coefficient
        rho, of the pulley; 0 for none.
    normal
        Normal force f_n, N/m; where it pulls there is none.
    velocity
        v_t, circumferential velocity of the point against the shaft, m/s.
    """
    if coefficient == 0.0 or normal <= 0.0:
        return RollingResistance(0.0, 0.0, 0.0)
    root = sqrt(velocity * velocity + CREEPING * CREEPING)
    share = -coefficient * velocity / root
    fading = CREEPING / root
    return RollingResistance(share * normal, share, -coefficient * normal / root * fading * fading)

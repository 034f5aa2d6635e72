"""Pulleys of belt conveyors by DIN 22101."""

from math import inf, pi
from types import MappingProxyType

_DIAMETERS = (0.1, 0.125, 0.16, 0.2, 0.25, 0.315, 0.4, 0.5, 0.63, 0.8, 1.0, 1.25)
"""Standard diameters of conveyor pulleys up to 1.25 m, m, ascending; smaller pulleys are chosen by steps along them."""
_LARGE = MappingProxyType({1.4: (1.4,), 1.6: (1.6,), 1.8: (1.4, 1.8), 2.0: (1.6, 2.0)})
"""Standard diameter above the series -> what follows the series up to it, m."""
LITTLE_WRAP = pi / 6.0
"""Wrap angle up to which a pulley only deflects the belt, rad."""
_STEPS = ((0.3, (2, 2, 3)), (0.6, (1, 2, 3)), (inf, (0, 1, 2)))
"""Up to a share of the allowed tension: standard diameters by which pulleys may be smaller, of drive pulleys and others
at high tension, of those at low tension, and of those with little wrap."""


def standard_diameter(diameter: float) -> float:
    """Smallest standard diameter of conveyor pulleys that is not below one, m; the largest beyond them."""
    standard = (*_DIAMETERS, *_LARGE)
    return next((one for one in standard if one >= diameter * (1.0 - 1e-9)), standard[-1])


def smallest_pulley(drive_diameter: float, utilization: float, wrap: float, high_tension: bool) -> float:
    """Smallest diameter of a pulley, m, by the table of DIN 22101.

    Parameters
    ----------
    drive_diameter : float
        Smallest diameter of the drive pulley of a fully used belt, m.
    utilization : float
        Largest tension in steady running over that which the safety factor allows.
    wrap : float
        Wrap angle, rad.
    high_tension : bool
        Whether it drives, or lies where the tension is high.

    Examples
    --------
    >>> from beltdyn.theory.conveyor import smallest_pulley
    >>> [smallest_pulley(0.63, used, 3.14, True) for used in (0.9, 0.5, 0.2)]
    [0.63, 0.5, 0.4]
    """
    group = 2 if wrap <= LITTLE_WRAP else 0 if high_tension else 1
    steps = next(by_group[group] for most, by_group in _STEPS if utilization <= most)
    largest = standard_diameter(drive_diameter)
    smaller = [one for one in _DIAMETERS if one <= largest]
    smaller += _LARGE.get(largest, ())
    return smaller[max(len(smaller) - 1 - steps, 0)]

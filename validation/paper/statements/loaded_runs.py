"""The runs behind Figs. 10-13, by name."""

from collections.abc import Callable
from functools import partial
from itertools import product

from beltdyn.model import Drive
from validation.paper.numbers import power_of_ten
from validation.published import better, loaded_two_pulley

POINTS = (5, 7, 11)
"""Gauss points an element that the paper compares."""

FACTORS = {"1e4": 1e4, "1e5": 1e5}
"""Creep-rate factors, kg/(m s)."""

POWERS = {name: power_of_ten(factor) for name, factor in FACTORS.items()}
"""The same as they are printed."""

FINE = 120
"""Elements of the fine mesh."""

LOAD = 45.0
"""Torque on the driven pulley, N m."""

PULLEYS = ("driver", "driven")
KINDS = ("normal", "friction")


def published_name(factor: str, points: int = POINTS[-1]) -> str:
    """Name of a run with published settings."""
    return f"loaded_{factor}_{points}_points"


def _with_points(points: int, factor: str) -> str:
    return published_name(factor, points)


def zone_name(factor: str, points: int) -> str:
    """Name of a run whose contact is integrated over the zone, from equilibrium."""
    return f"loaded_{factor}_{points}_points_better"


def fine_name(factor: str) -> str:
    """Name of a run with a finer mesh too."""
    return f"loaded_{factor}_{FINE}_elements_better"


SETTINGS: dict[str, Callable[[str], str]] = {
    **{f"as published, {n} points": partial(_with_points, n) for n in POINTS},
    f"better settings, {FINE} elements": fine_name,
}
"""Settings -> the name of their run for a creep-rate factor."""

PUBLISHED = len(POINTS)
"""How many of the settings are published: the paper does not say with how many points its figures were made."""


def loaded_cases() -> dict[str, Drive]:
    """Both factors with 5, 7 and 11 points over whole elements and on the zone, and on a fine mesh."""
    drives: dict[str, Drive] = {}
    for factor, points in product(FACTORS, POINTS):
        drive = loaded_two_pulley(FACTORS[factor], points)
        drives |= {published_name(factor, points): drive, zone_name(factor, points): better(drive)}
    return drives | {fine_name(factor): better(loaded_two_pulley(value), FINE) for factor, value in FACTORS.items()}

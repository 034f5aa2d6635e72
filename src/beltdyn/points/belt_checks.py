"""What a belt of a rated profile has to meet: power, tension, speed, pulleys, length, slip."""

from collections.abc import Iterator, Sequence
from math import isnan
from typing import Any, NamedTuple

import numpy as np

from beltdyn.model import Drive, Installation
from beltdyn.model.belt_loads import RequiredTension
from beltdyn.model.rating import RatedBelt
from beltdyn.model.toothing import RatedTeeth
from beltdyn.results import Variable
from beltdyn.results.schema import VARIOUS

_LIMIT_TOLERANCE = 1e-9
"""Relative excess over a limit that counts as none: with it, a value that equals its limit meets it despite
rounding."""
_SAME_LENGTH = 5e-4
"""Difference of a length from a standard one that rounding on a label explains, m."""
_CHECK = ("check",)
SLIP_SAFETY = "slip safety of all loads"


class BeltCheck(NamedTuple):
    """A value of a drive against its limit."""

    name: str
    value: float
    """SI; NaN where it is unknown, which meets nothing."""
    limit: float
    unit: str
    at_most: bool = False
    """Whether the limit is an upper one."""
    decides: bool = True
    """Whether the verdict depends on it; of makers' rules for the same value, on the lowest alone."""

    @property
    def is_met(self) -> bool:
        """Whether the value is within the limit."""
        if isnan(self.value):
            return False
        room = (1.0 + _LIMIT_TOLERANCE) * self.limit
        return self.value <= room if self.at_most else (1.0 + _LIMIT_TOLERANCE) * self.value >= self.limit


def checks_of(
    drive: Drive,
    belt: RatedBelt | RatedTeeth,
    rest: Installation,
    required: RequiredTension | None,
    running: "Loads",
) -> Iterator[BeltCheck]:
    """All checks of a drive with its rated belt, by the limits of the drive where it has its own."""
    used, most = float(np.nanmax(running.utilization)), drive.limits.largest_utilization or 1.0
    yield BeltCheck("utilization of the rated power", used, most, "1", at_most=True)
    for number, (name, tension) in enumerate(() if required is None else required.by_formula.items()):
        yield BeltCheck(f"tension at rest, {name}", rest.tension, tension, "N", decides=number == 0)
    if not isnan(running.slip_safety):
        yield BeltCheck(SLIP_SAFETY, running.slip_safety, drive.limits.least_slip_safety or 1.0, "1")
    yield BeltCheck("belt speed", running.speed, belt.rating.largest_speed, "m/s", at_most=True)
    smallest = drive.belt.smallest_diameter
    if smallest is not None:
        diameters = [2.0 * one.radius for one in drive.pulleys if one.side == "inside"]
        yield BeltCheck("smallest pulley", min(diameters), smallest, "m")
    lengths = () if drive.belt.entry is None else drive.belt.entry.lengths
    if lengths:
        nominal = drive.belt.nominal_length_of(drive.belt_length)
        nearest = min(lengths, key=lambda one: abs(one - nominal))
        away = max(abs(nearest - nominal) - _SAME_LENGTH, 0.0)
        yield BeltCheck("distance from a standard length", away, 0.0, "m", at_most=True, decides=False)


class Loads(NamedTuple):
    """What steady running gives for the checks."""

    utilization: Any
    slip_safety: float
    """Least of all pulleys; zero where the belt slips through, NaN where teeth hold it."""
    speed: float
    """Of the belt, m/s."""


def verdict_of(checks: Sequence[BeltCheck]) -> str:
    """Whether a drive passes, and what it does not meet."""
    failed = [one.name for one in checks if one.decides and not one.is_met]
    doubtful = [one.name for one in checks if not one.decides and not one.is_met]
    words = f"fails: {', '.join(failed)}" if failed else "passes"
    return f"{words}; not met: {', '.join(doubtful)}" if doubtful else words


def variables_of(checks: Sequence[BeltCheck]) -> dict[str, tuple[Variable, Any]]:
    """Variables along ``check``."""
    flag, various = "int64", (_CHECK, VARIOUS)
    return {
        "check_value": (Variable(*various, "Value"), [one.value for one in checks]),
        "check_limit": (Variable(*various, "Limit"), [one.limit for one in checks]),
        "check_at_most": (
            Variable(_CHECK, "1", "Whether the limit is an upper one", flag),
            [one.at_most for one in checks],
        ),
        "check_met": (Variable(_CHECK, "1", "Whether it is met", flag), [one.is_met for one in checks]),
        "check_unit": (Variable(_CHECK, "1", "Unit of the check", "str"), [one.unit for one in checks]),
    }

"""The belt of a conveyor: safety factors by its class, smallest pulleys, and the travel of its take-up."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.line_motions import MOTIONS, Motions
from beltdyn.machines import Tensioner
from beltdyn.model import Drive, Prepared
from beltdyn.results import Variable
from beltdyn.theory.conveyor import smallest_pulley

USUAL_TEMPERATURES = (-10.0, 40.0)
"""Range of the temperature of a belt in the open, °C; an estimate."""
STRETCHES = {
    "running_stretch": "Stretch of the belt in steady running",
    "start_stretch": "Stretch of the belt in starts",
}
"""Over the travel of the take-up by its ratio, m."""
ELONGATIONS = {
    "largest_stretch": "Largest stretch of the belt, in steady running or starts",
    "permanent_elongation": "Permanent elongation of the belt over its life",
    "thermal_elongation": "Elongation of the belt by heat",
}
"""Parts of what a take-up takes up, m."""
_PULLEY, _MOTION = ("pulley",), ("motion",)
_HIGH = 0.5
"""Part of the way from the least to the largest tension from which it is high for a pulley."""

Values = dict[str, tuple[Variable, Any]]


class Needed(NamedTuple):
    """Least safety factors of a belt, NaN where none is known."""

    running: float
    motions: float

    @classmethod
    def of(cls, drive: Drive) -> "Needed":
        """Limits of the drive file, or else those of the class."""
        limits, entry = drive.limits, drive.belt.entry
        running, motions = (None, None) if entry is None else (entry.least_safety, entry.least_motion_safety)
        found = (limits.least_belt_safety or running, limits.least_motion_safety or motions)
        return cls(*(np.nan if one is None else one for one in found))


def safety_values(drive: Drive, tensions: FloatArray, motions: Motions) -> Iterator[tuple[str, tuple[Variable, Any]]]:
    """Safety factors of the belt, and the smallest pulleys that it allows; `tensions`: largest of each span, N."""
    breaking, needed = drive.belt.breaking_force, Needed.of(drive)
    if breaking is None:
        return
    largest = float(tensions.max())
    in_motions = motions.tensions.max(axis=(1, 2))
    yield "belt_safety", (Variable((), "1", "Safety factor of the belt in steady running"), breaking / largest)
    label = "Safety factor of the belt in starts and stops"
    yield "motion_belt_safety", (Variable(_MOTION, "1", label), breaking / in_motions)
    yield "needed_belt_safety", (Variable((), "1", "Least safety factor in steady running"), needed.running)
    yield "needed_motion_safety", (Variable((), "1", "Least safety factor in starts and stops"), needed.motions)
    diameter = drive.belt.smallest_diameter
    if diameter is not None:
        used = 1.0 if np.isnan(needed.running) else largest * needed.running / breaking
        tight = motions.running_at_pulleys.max(axis=0)
        high = motions.powered | (tight > tight.min() + _HIGH * (largest - tight.min()))
        wraps = motions.at["wrap_angle"].values.tolist()
        label = "Smallest diameter by the belt (DIN 22101)"
        least = [smallest_pulley(diameter, used, wrap, bool(one)) for wrap, one in zip(wraps, high, strict=True)]
        yield "smallest_diameter", (Variable(_PULLEY, "m", label), least)


def safety_warnings(drive: Drive, values: Mapping[str, tuple[Variable, Any]], point: str) -> Iterator[str]:
    """Safety factors that are too low, and pulleys that are too small, at an operating point."""
    if "belt_safety" not in values:
        return
    needed = Needed.of(drive)
    factors = {"steady running": (values["belt_safety"][1], needed.running)}
    factors |= {
        name: (one, needed.motions) for name, one in zip(MOTIONS, values["motion_belt_safety"][1].tolist(), strict=True)
    }
    for name, (factor, least) in factors.items():
        if factor < least:
            yield (
                f"the safety factor of the belt is {factor:.3g} in {name} at operating point {point}, but "
                f"{least:.3g} are needed. Use a stronger class, or reduce the tension."
            )
    diameters = values["smallest_diameter"][1] if "smallest_diameter" in values else []
    for pulley, least in zip(drive.pulleys, diameters, strict=False):
        if 2.0 * pulley.radius < (1.0 - 1e-9) * least:
            yield (
                f"the diameter of {pulley.name} is {2e3 * pulley.radius:.4g} mm, but the belt needs "
                f"{1e3 * least:.4g} mm at the tension of operating point {point} (DIN 22101). Use a larger pulley."
            )


def take_up(prepared: Prepared, variables: Values, wear: float | None) -> tuple[Values, list[str]]:
    """Travel of a take-up from the belt without tension to starts of one that is longer by wear and heat.

    `wear`: elongation, m, in place of that of the belt by its life and heat.
    """
    belt, length, ratio = prepared.belt, prepared.belt_length, float(variables["take_up_ratio"][1])
    low, high = belt.temperature_range or USUAL_TEMPERATURES
    heat, permanent = belt.thermal_expansion, belt.permanent_elongation
    if wear is None and permanent is None and heat is None:
        return {}, []
    stretch = max(float(np.max(variables[name][1])) for name in STRETCHES)
    parts = (
        stretch,
        wear if wear is not None else (permanent or 0.0) * length,
        0.0 if heat is None or wear is not None else heat * (high - low) * length,
    )
    values: Values = {
        name: (Variable((), "m", label), part) for (name, label), part in zip(ELONGATIONS.items(), parts, strict=True)
    }
    travel, label = sum(parts) / ratio, "Travel of the take-up over the life of the belt"
    values["take_up_travel"] = Variable((), "m", label), travel
    values["temperature_difference"] = Variable((), "K", "Range of the temperature of the belt"), high - low
    tensioner = take_up_tensioner(prepared)
    room = None if tensioner is None else tensioner.frame_travel
    if room is None:
        return values, []
    values["take_up_room"] = Variable((), "m", "Travel that the frame leaves to the take-up"), room
    short = (
        f"the take-up needs a travel of {travel:.3g} m over the life of the belt, but has {room:.3g} m. Give it more."
    )
    return values, [short] if travel > room else []


def take_up_tensioner(prepared: Prepared) -> Tensioner | None:
    """The first tensioner along a line; None without one."""
    return next((one for one in prepared.drive.tensioners if not one.turns), None)

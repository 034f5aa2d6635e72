"""Loads of pulleys on their belt: powers, pulls, and the tension at rest that these require by the rules of makers."""

import math
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.machines.loads.load import Load
from beltdyn.model.belt import Belt
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.theory.rating import RUN_IN, TENSION_FORMULAS, least_rest_tension, least_tension

MAKERS = tuple(TENSION_FORMULAS)
"""Of formulas of the tension at rest of V- and V-ribbed belts, from the lowest to the highest."""
OF_TEETH = "Siegling, with a tenth of the pull in the slack span"
"""The rule of toothed belts."""
_ANGLES = 64
"""Angles over which the torque of a load is averaged."""


class RequiredTension(NamedTuple):
    """The least tension at rest with which a belt between fixed centers carries its load."""

    pull: float
    """Largest of a pulley with the service factor, N."""
    by_formula: dict[str, float]
    """By each maker's formula, ascending, N."""
    load: str = ""
    """What pulls, where it is not a power, in words."""

    @property
    def tension(self) -> float:
        """By the formula that requires most, N."""
        return max(self.by_formula.values())


class BeltLoads(NamedTuple):
    """Pulleys with a driver, and their belt."""

    pulleys: tuple[Pulley, ...]
    driver: int
    belt: Belt
    service_factor: float
    begin: float
    """Instants between which the speed of the driver is looked at, s; loads are those of the end."""
    end: float

    def powers_drawn(self, path: Path) -> tuple[FloatArray, float]:
        """Power drawn from the belt by each pulley, W, and belt speed, m/s, at the highest speed of the driver."""
        radii, speed = path.radii, self.pulleys[self.driver].extreme_speed(self.begin, self.end)
        taken = np.zeros(len(self.pulleys))
        for number, one in enumerate(self.pulleys):
            if number == self.driver:
                continue
            turning = speed * float(radii[self.driver] / radii[number])
            loads = sum(_torque(load, turning, self.end) for load in one.load if load.has_mean)
            taken[number] = -(torque_of_file(one, self.end) + loads) * turning
        return taken, abs(speed * float(radii[self.driver]))

    def required_tension(self, path: Path) -> RequiredTension | None:
        """The tension at rest that the loads require; None without a rated profile, a speed or loads."""
        belt, entry = self.belt, self.belt.entry
        if entry is None or (entry.rating is None and entry.tooth_rating is None):
            return None
        powers, speed = self.powers_drawn(path)
        if not speed > 0.0 or not powers.max() > 0.0:
            return None
        powers[self.driver] = -powers.sum()
        pulls = self.service_factor * np.abs(powers) / speed
        if belt.teeth is not None:
            pull = float(pulls.max())
            return RequiredTension(pull, {OF_TEETH: least_rest_tension(pull, belt.mass_per_length, speed)})
        loaded = np.flatnonzero(pulls > 0.0)
        by_formula = {
            name: max(
                least_tension(float(pulls[p]), float(path.wrap_angles[p]), belt.mass_per_length, speed, grip)
                for p in loaded
            )
            for name, grip in TENSION_FORMULAS.items()
        }
        return RequiredTension(float(pulls.max()), by_formula)

    def run_in_tension(self, path: Path) -> float | None:
        """Tension of a run-in V-belt or V-ribbed belt that the loads require, N; None where there is no rule."""
        required = None if self.belt.teeth is not None else self.required_tension(path)
        return None if required is None else RUN_IN * required.tension


def torque_of_file(pulley: Pulley, time: float) -> float:
    """Torque that the drive file gives a pulley beside its loads, at an instant (s), N m."""
    return 0.0 if pulley.torque is None else float(pulley.torque.at([time])[0])


def _torque(load: Load, speed: float, time: float) -> float:
    """Torque of a load at a speed and an instant, N m, averaged over its angle."""
    factor = 1.0 if load.factor is None else float(load.factor.at([time])[0])
    return factor * float(load.torque_over(np.linspace(0.0, 4.0 * math.pi, _ANGLES), speed, time).mean())

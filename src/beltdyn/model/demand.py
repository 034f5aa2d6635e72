"""What the loads of a drive demand of its belt: powers, pulls, and the tension at rest by the rules of makers."""

import math
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.machines.loads.load import Load
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation
from beltdyn.theory.rating import TENSION_FORMULAS, least_rest_tension, least_tension

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

    @property
    def tension(self) -> float:
        """By the formula that requires most, N."""
        return max(self.by_formula.values())


def required_tension(drive: Drive, installation: Installation) -> RequiredTension | None:
    """The tension at rest that the loads require by the rules of makers; None where these do not apply.

    They apply to belts of a rated profile between fixed centers, with a driver and loads that are known. The design
    power is that at the highest speed of the driver times `limits.service_factor`.
    """
    driver = drive.driver
    belt = drive.belt
    held = bool(drive.moving_tensioners) or bool(drive.ends) or drive.carriage is not None
    if driver is None or held or drive.rated_belt is None:
        return None
    powers, speed = powers_drawn(drive, driver, installation)
    if not speed > 0.0 or not powers.max() > 0.0:
        return None
    powers[driver] = -powers.sum()
    pulls = (drive.limits.service_factor or 1.0) * np.abs(powers) / speed
    if belt.teeth is not None:
        pull = float(pulls.max())
        return RequiredTension(pull, {OF_TEETH: least_rest_tension(pull, belt.mass_per_length, speed)})
    loaded = np.flatnonzero(pulls > 0.0)
    wraps = installation.path.wrap_angles
    by_formula = {
        name: max(least_tension(float(pulls[p]), float(wraps[p]), belt.mass_per_length, speed, grip) for p in loaded)
        for name, grip in TENSION_FORMULAS.items()
    }
    return RequiredTension(float(pulls.max()), by_formula)


def powers_drawn(drive: Drive, driver: int, installation: Installation) -> tuple[FloatArray, float]:
    """Power drawn from the belt by each pulley, W, and belt speed, m/s, at the highest speed of the driver."""
    pulley, radii = drive.pulleys[driver], installation.path.radii
    time = drive.simulation.end
    if pulley.speed is None:
        speed = pulley.driven_speed() * pulley.turning
    else:
        times = np.linspace(drive.simulation.begin, time, 1001)
        values = pulley.speed.at(times)
        time, speed = float(times[np.argmax(np.abs(values))]), float(values[np.argmax(np.abs(values))])
    taken = np.zeros(len(drive.pulleys))
    for number, one in enumerate(drive.pulleys):
        if number == driver:
            continue
        turning = speed * float(radii[driver] / radii[number])
        loads = sum(_torque(load, turning, drive.simulation.end) for load in one.load if load.has_mean)
        taken[number] = -(prescribed_torque(drive, number) + loads) * turning
    return taken, abs(speed * float(radii[driver]))


def prescribed_torque(drive: Drive, number: int) -> float:
    """Torque that the drive file gives a pulley beside its loads, at the end of the run, N m."""
    torque = drive.pulleys[number].torque
    return 0.0 if torque is None else float(torque.at([drive.simulation.end])[0])


def _torque(load: Load, speed: float, time: float) -> float:
    """Torque of a load at a speed and an instant, N m, averaged over its angle."""
    factor = 1.0 if load.factor is None else float(load.factor.at([time])[0])
    return factor * float(load.torque_over(np.linspace(0.0, 4.0 * math.pi, _ANGLES), speed, time).mean())

"""Detection of gross slip, which ends the run: what follows would not be what the drive is for."""

import numpy as np

from beltdyn.errors import SlipError
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.results.checks.sliding import SWEEP_REMEDY
from beltdyn.results.mechanics import across
from beltdyn.solve.observation.observer import Arrays

_FAST = 0.05
"""Velocity of sliding of a whole arc, over the speed of the swept pulley's rim, from which on it counts."""


class SlipThrough:
    """Watches the outputs of a run-up.

    Parameters
    ----------
    drive : Drive
        What is simulated.
    swept : int
        Number of the pulley whose speed rises.
    """

    def __init__(self, drive: Drive, swept: int) -> None:
        self._drive, self._swept, self._radius = drive, swept, float(drive.radii[swept])
        self._since = np.full(len(drive.pulleys), np.inf)
        self._load = np.zeros(len(drive.pulleys))
        self._speed = np.zeros(len(drive.pulleys))

    def __call__(self, outputs: Arrays) -> None:
        """Look at further outputs.

        Raises
        ------
        SlipError
            If the whole arc of a pulley slides for a turn of the belt, faster than 5 % of the swept rim's speed.
        """
        for row, time in enumerate(outputs["time"]):
            sliding = np.abs(outputs["sliding_speed"][row])
            speed = float(outputs["pulley_speed"][row, self._swept])
            rim = abs(speed) * self._radius
            fast = sliding > _FAST * rim
            begins = fast & np.isinf(self._since)
            self._since = np.where(fast, np.where(begins, time, self._since), np.inf)
            self._load = np.where(begins, np.abs(outputs["pulley_torque"][row]), self._load)
            self._speed = np.where(begins, speed, self._speed)
            for number in np.flatnonzero(time - self._since > self._drive.belt_length / max(rim, 1e-9)):
                raise SlipError(self._message(int(number), time, speed, outputs, row), SWEEP_REMEDY)

    def _message(self, number: int, time: float, speed: float, outputs: Arrays, row: int) -> str:
        name, swept = (self._drive.pulleys[one].name for one in (number, self._swept))
        before, after = (float(side[number]) for side in across(outputs["span_tension"][row], self._drive))
        sliding = abs(float(outputs["sliding_speed"][row, number]))
        share = sliding / (abs(speed) * self._radius)
        return (
            f"the sweep stops at t = {time:.4g} s, {swept} at {RPM * speed:.4g} rpm: {name} is in gross slip. "
            f"Since {RPM * self._speed[number]:.4g} rpm its whole arc has been sliding, now at {sliding:.3g} "
            f"m/s, {share:.0%} of the rim speed of {swept}. At the onset it had to transmit "
            f"{self._load[number]:.4g} N m, more than friction can transmit with the tensions of "
            f"{max(before, after):.4g} and {min(before, after):.4g} N in the adjacent spans."
        )

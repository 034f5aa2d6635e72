"""What checks look at, and what they have in common."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.parts.finding import Finding
from beltdyn.results.balance import Balance, power_balance
from beltdyn.results.cycles import mean_window
from beltdyn.results.means import PulleySummary, pulley_means, span_means
from beltdyn.results.recorded import Recorded
from beltdyn.results.resolution import Resolution
from beltdyn.results.window import Window

IDLE = 0.01
"""Power put in over tension times belt speed up to which a drive idles."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What checks look at; a run with at least one output.

    Attributes
    ----------
    recorded : Recorded
        The results.
    drive : Drive
        The drive.
    resolution : Resolution
        How well its mesh resolves tension and contact.
    """

    recorded: Recorded
    drive: Drive
    resolution: Resolution

    @cached_property
    def time(self) -> FloatArray:
        """Times of the outputs, s."""
        return np.asarray(self.recorded["time"])

    @cached_property
    def window(self) -> Window:
        """What means are taken over."""
        return mean_window(self.recorded, self.drive)

    @cached_property
    def pulleys(self) -> tuple[PulleySummary, ...]:
        """Means of the pulleys over the end of the run."""
        return pulley_means(self.recorded, self.drive, self.window)

    @cached_property
    def balance(self) -> Balance:
        """Powers over the end of the run."""
        return power_balance(self.recorded, self.window)

    @cached_property
    def power(self) -> float:
        """Power that shares are told of, W: that put in, and no less than `IDLE` of tension times belt speed.

        What a drive that idles loses is no part of a power that is transmitted.
        """
        spans = span_means(self.recorded, self.drive, self.window)
        carried = max((one.tension * abs(one.belt_speed) for one in spans), default=0.0)
        return max(self.balance.power_in, IDLE * carried)


Check = Callable[[Evidence], Iterator[Finding]]

_FINER = 10.0
"""How many times smaller a tolerance is that a remedy names."""


def shorter_steps(drive: Drive) -> str:
    """The remedy where time steps are too long; steps of a second-order method grow with the root of the tolerance."""
    rtol = drive.simulation.rtol
    return f"Set simulation.rtol = {rtol / _FINER:g} in place of {rtol:g}; a run then takes about three times as long."

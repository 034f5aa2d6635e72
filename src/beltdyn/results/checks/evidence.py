"""The data that checks examine, and their common parts."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.parts.messages import Finding
from beltdyn.results.cycles import Window, mean_window
from beltdyn.results.energy_balance import Balance, lifting_power, power_balance
from beltdyn.results.means import PulleySummary, SpanSummary, span_means
from beltdyn.results.provenance import Resolution
from beltdyn.results.schema import Recorded
from beltdyn.results.tooth_loads import ToothLoads, extreme_loads

IDLE = 0.01
"""Power input over tension times belt speed below which a drive idles."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """The data that checks examine: a run with at least one output."""

    recorded: Recorded
    """The results."""
    prepared: Prepared
    """The drive."""
    resolution: Resolution
    """How well its mesh resolves tension and contact."""
    find_pulleys: Callable[[], tuple[PulleySummary, ...]]
    """Gives the means of the pulleys over the end of the run."""

    @cached_property
    def time(self) -> FloatArray:
        """Times of the outputs, s."""
        return np.asarray(self.recorded["time"])

    @cached_property
    def window(self) -> Window:
        """The averaging window."""
        return mean_window(self.recorded, self.prepared)

    @cached_property
    def pulleys(self) -> tuple[PulleySummary, ...]:
        """Means of the pulleys over the end of the run."""
        return self.find_pulleys()

    @cached_property
    def spans(self) -> tuple[SpanSummary, ...]:
        """Means of the spans over the end of the run."""
        return span_means(self.recorded, self.prepared, self.window)

    @cached_property
    def tooth_loads(self) -> tuple[ToothLoads, ...]:
        """Extremes of the loads of teeth on each pulley."""
        return extreme_loads(self.recorded, self.prepared)

    @cached_property
    def balance(self) -> Balance:
        """Powers over the end of the run."""
        lifted = lifting_power(self.recorded, self.prepared, self.window)
        return power_balance(self.recorded, self.window, lifted)

    @cached_property
    def power(self) -> float:
        """Reference power of shares, W: the power input, and no less than `IDLE` of tension times belt speed.

        The losses of an idling drive are not a share of a transmitted power.
        """
        carried = max((one.tension * abs(one.belt_speed) for one in self.spans), default=0.0)
        return max(self.balance.power_in, IDLE * carried)


Check = Callable[[Evidence], Iterator[Finding]]

_FINER = 10.0
"""Factor by which a remedy reduces a tolerance."""


def shorter_steps(prepared: Prepared) -> str:
    """The remedy for long time steps; the steps of a second-order method scale with the root of the tolerance."""
    rtol = prepared.simulation.rtol
    return f"Reduce simulation.rtol from {rtol:g} to {rtol / _FINER:g}; a run then takes about three times as long."

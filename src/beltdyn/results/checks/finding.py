"""The shape of a finding, and what checks look at."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results.cycles import mean_window
from beltdyn.results.means import PulleySummary, pulley_means
from beltdyn.results.recorded import Recorded
from beltdyn.results.resolution import Resolution
from beltdyn.results.window import Window


@dataclass(frozen=True, slots=True)
class Finding:
    """What makes a result doubtful, in whole sentences or parts of one with their punctuation.

    Attributes
    ----------
    fault : str
        What is wrong, with its value and the rule that it breaks.
    spoils : str
        Which numbers it spoils and by how much; empty when `fault` says it.
    remedy : str
        What to do.
    """

    fault: str
    spoils: str = ""
    remedy: str = ""

    def __str__(self) -> str:
        return " ".join(part for part in (self.fault, self.spoils, self.remedy) if part)


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


Check = Callable[[Evidence], Iterator[Finding]]

"""Progress of a simulation."""

import math
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

FORECAST = 0.05
"""Part of a run that must be done before the rest is forecast: the beginning, where speeds jump, is slow."""
_LATELY, _OFTEN = 5.0, 0.2
"""Computing time over which the pace is taken, and between the marks that it is taken from, s."""

Phase = Literal[
    "compiling",
    "equilibrium",
    "settling",
    "integrating",
    "operating points",
    "designs",
    "points",
    "no workers",
]


@dataclass(frozen=True)
class Progress:
    """Progress of a simulation."""

    time: float
    """Simulated time since the beginning, s."""
    duration: float
    """Total simulated time, s."""
    step_size: float
    """Latest step of the solver, s; zero before the first one."""
    outputs_written: int
    """Outputs recorded so far."""
    phase: Phase = "integrating"
    """"compiling" (the kernels, once per machine), "equilibrium", "settling" (at the first speed of a run-up),
    "integrating", or "operating points", "designs" and "points" (of a study), for which time and duration are the
    numbers done and in total; "no workers" while a cluster has no workers."""
    elapsed: float = 0.0
    """Computing time since the first step, s."""
    bound: str = ""
    """What limits the time steps, in words; empty before the first step."""
    pace: float = math.nan
    """Recent simulated time over computing time; by default the mean so far."""

    @property
    def remaining(self) -> float:
        """Estimated remaining computing time, s; NaN in the first twentieth."""
        if not self.time >= FORECAST * self.duration:
            return math.nan
        pace = self.pace
        if math.isnan(pace) and self.time > 0.0 and self.elapsed > 0.0:
            pace = self.time / self.elapsed
        return (self.duration - self.time) / pace if pace > 0.0 else math.nan


class Pace:
    """How quickly a simulation gets on, over the last seconds of computing."""

    def __init__(self) -> None:
        self._marks: deque[tuple[float, float]] = deque()

    def at(self, elapsed: float, reached: float) -> float:
        """Note where it stands, and tell simulated time over computing time."""
        marks = self._marks
        if not marks or elapsed - marks[-1][0] > _OFTEN:
            marks.append((elapsed, reached))
        while len(marks) > 1 and elapsed - marks[1][0] >= _LATELY:
            marks.popleft()
        spent = elapsed - marks[0][0]
        return (reached - marks[0][1]) / spent if spent > 0.0 else math.nan


Report = Callable[[Progress], None]
"""Callback for progress."""


@dataclass(frozen=True, slots=True)
class BatchProgress:
    """Progress of several simulations."""

    done: int
    """Number of finished simulations."""
    total: int
    """Number of all simulations."""
    running: Mapping[Path, float]
    """Result file -> completed share, 0 to 1, of running simulations."""
    share: float | None = None
    """Completed share of all work, 0 to 1, where simulations take different times; by default that of their number."""
    kind: str = "runs"
    """What is computed, in words."""

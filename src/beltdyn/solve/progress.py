"""How far a simulation has come."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

Phase = Literal["compiling", "equilibrium", "integrating"]


@dataclass(frozen=True)
class Progress:
    """Where a simulation stands.

    Attributes
    ----------
    time : float
        Simulated time, s.
    duration : float
        Time at which the simulation ends, s.
    step_size : float
        Latest step of the solver, s; zero before the first one.
    outputs_written : int
        Outputs recorded so far.
    phase : str
        "compiling" (the kernels, once on a machine), "equilibrium" or "integrating".
    elapsed : float
        Computing time since the first step, s.
    bound : str
        What bounds the time steps, in words; empty before the first one.
    """

    time: float
    duration: float
    step_size: float
    outputs_written: int
    phase: Phase = "integrating"
    elapsed: float = 0.0
    bound: str = ""

    @property
    def remaining(self) -> float:
        """Computing time that is left if it goes on as until now, s; NaN before the first step."""
        if self.time <= 0.0 or self.elapsed <= 0.0:
            return math.nan
        return self.elapsed * (self.duration - self.time) / self.time


Report = Callable[[Progress], None]
"""What a caller gives to be told of progress."""


@dataclass(frozen=True, slots=True)
class BatchProgress:
    """Where many simulations stand.

    Attributes
    ----------
    done, total : int
        Simulations that ended, and all.
    running : mapping
        Result file -> part that is done, 0 to 1, of those on their way.
    """

    done: int
    total: int
    running: Mapping[Path, float]

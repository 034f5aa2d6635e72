"""How far a simulation has come."""

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
    """

    time: float
    duration: float
    step_size: float
    outputs_written: int
    phase: Phase = "integrating"


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

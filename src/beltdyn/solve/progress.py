"""How far a simulation has come."""

from collections.abc import Callable
from dataclasses import dataclass
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

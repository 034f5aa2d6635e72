"""The instant at which an analysis takes a drive that changes over time."""

from beltdyn.model import Drive
from beltdyn.parts.number_range import number_in


def instant_given(drive: Drive, at: float | str | None) -> float:
    """The instant that is asked for, such as "0.5 s", or in s; by default the end of the simulation; in s.

    Raises
    ------
    ModelError
        If it is no time.
    """
    return drive.simulation.end if at is None else number_in("at", at, "s")

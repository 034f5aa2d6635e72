"""Jumps of a toothed belt: it rides up on the teeth of a pulley and comes down in other grooves (ratcheting)."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.errors import ModelError
from beltdyn.results.schema import Recorded

if TYPE_CHECKING:
    from beltdyn.results.result import Result

JUMPS: Final = ("jump_time", "jump_pulley", "jump_teeth")
"""Attributes of a result: times of jumps (s), numbers of pulleys, grooves by which the belt went ahead."""


@dataclass(frozen=True, slots=True)
class Jump:
    """A jump of the belt by a tooth.

    Examples
    --------
    >>> bd.results.jumps(run)
    ()
    """

    time: float
    """s."""
    name: str
    """Name of the pulley."""
    teeth: int
    """1 if the belt went ahead of the pulley by a groove, in the sense of ascending belt coordinate; -1 if it fell
    back."""


def jumps(run: "Result") -> tuple[Jump, ...]:
    """Jumps of a toothed belt in a run.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    tuple of Jump
        In the order in which they happened, tooth by tooth; empty where none happened or the belt has no teeth. Where
        the teeth in mesh are off the grooves that hold them by 0.7 pitches on average, the belt has jumped.

    Raises
    ------
    ModelError
        If the result is not a run.

    Examples
    --------
    >>> bd.results.jumps(run)
    ()
    """
    if run.kind != RUN:
        raise ModelError(f"jumps need results over time; these are of {run.kind}. Use a run.")
    return jumps_in(run.dataset, [pulley.name for pulley in run.prepared.pulleys])


def jumps_in(recorded: "Recorded", names: list[str]) -> tuple[Jump, ...]:
    """Jumps that a result tells of, with names of the pulleys."""
    columns = [np.atleast_1d(recorded.attrs.get(name, np.zeros(0))) for name in JUMPS]
    return tuple(
        Jump(float(time), names[int(pulley)], int(teeth)) for time, pulley, teeth in zip(*columns, strict=True)
    )

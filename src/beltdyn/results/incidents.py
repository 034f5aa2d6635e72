"""Events at any time of a run: gross slip, slack spans, jumps of a toothed belt, tensioners on a stop."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.arrays import BoolArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.mechanics import rim_speeds
from beltdyn.results.schema import Recorded, names

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


SLIDING_LIMIT = 1e-3
"""Sliding speed of a whole arc, over the belt speed, above which it is gross slip."""
GROSS_SLIP, SLACK, JUMP, STOP = "gross slip", "slack", "jump", "stop"


@dataclass(frozen=True, slots=True)
class Incident:
    """An event at any time of a run."""

    kind: str
    """`GROSS_SLIP`, `SLACK`, `JUMP` or `STOP`."""
    name: str
    """Name of the pulley or the span."""
    periods: tuple[tuple[float, float], ...]
    """Start and end, s; empty in a result without time."""
    side: str = ""
    """"lower" or "upper" stop."""

    @property
    def severe(self) -> bool:
        """Whether it is a fault in any drive."""
        return self.kind != STOP

    def __str__(self) -> str:
        words = {
            GROSS_SLIP: f"the belt was in gross slip on {self.name}",
            SLACK: f"{self.name} went slack",
            JUMP: f"the belt jumped grooves of {self.name}",
            STOP: f"the tensioner of {self.name} was on its {self.side} stop",
        }[self.kind]
        if not self.periods:
            return words
        often = f", {len(self.periods)} times" if self.periods[1:] else ""
        begin, end = self.periods[0][0], self.periods[-1][1]
        when = f"at {begin:.4g} s" if begin == end else f"from {begin:.4g} to {end:.4g} s"
        return f"{words} {when}{often}"


def incidents(recorded: Recorded, prepared: Prepared) -> tuple[Incident, ...]:
    """Find the events of a run."""
    found = [
        (GROSS_SLIP, name, "", on) for name, on in _each(names(recorded, "pulley"), slides_through(recorded, prepared))
    ]
    found += [(SLACK, name, "", on) for name, on in _each(names(recorded, "span"), is_slack(recorded))]
    for side, stopped in zip(("lower", "upper"), on_stops(recorded, prepared), strict=True):
        found += [
            (STOP, name, side, on) for name, on in _each([one.pulley for one in prepared.moving_tensioners], stopped)
        ]
    time = np.asarray(recorded["time"])
    happened = [Incident(kind, name, _periods(time, on), side) for kind, name, side, on in found]
    return (*happened, *_jumps(recorded))


def _jumps(recorded: Recorded) -> Iterator[Incident]:
    """Jumps of a toothed belt, those on a pulley together."""
    events = jumps_in(recorded, names(recorded, "pulley"))
    for name in dict.fromkeys(one.name for one in events):
        yield Incident(JUMP, name, tuple((one.time, one.time) for one in events if one.name == name))


def slides_through(recorded: Recorded, prepared: Prepared) -> BoolArray:
    """Whether the belt slides on whole arcs, at two or more outputs in a row, shape (outputs, pulleys)."""
    sliding, speed = (np.asarray(recorded[name]) for name in ("sliding_speed", "pulley_speed"))
    slid = np.abs(sliding) > SLIDING_LIMIT * np.nanmax(np.abs(rim_speeds(speed, prepared)[:, prepared.reference]))
    if prepared.ends:
        return np.zeros_like(slid)
    slid &= prepared.gripping
    beside = np.pad(slid, ((1, 1), (0, 0)))
    return np.asarray(slid & (beside[:-2] | beside[2:])) if len(slid) > 1 else slid


def is_slack(recorded: Recorded) -> BoolArray:
    """Whether the tension of each span is zero or below anywhere along it, shape (outputs, spans)."""
    tension = np.asarray(recorded["least_span_tension"])
    return np.asarray(np.isfinite(tension) & (tension <= 0.0))


def on_stops(recorded: Recorded, prepared: Prepared) -> tuple[BoolArray, BoolArray]:
    """Whether tensioners lie on their lower and on their upper stop, shape (outputs, tensioners) each."""
    moving = prepared.moving_tensioners
    if not moving:
        none = np.zeros((len(np.asarray(recorded["time"])), 0), dtype=bool)
        return none, none
    stops = np.array([one.stops or (-np.inf, np.inf) for one in moving])
    position = np.asarray(recorded["tensioner_position"])
    return position <= stops[:, 0], position >= stops[:, 1]


def _each(labels: list[str], on: BoolArray) -> Iterator[tuple[str, BoolArray]]:
    """Names with at least one event, and when."""
    return ((name, column) for name, column in zip(labels, on.T, strict=True) if column.any())


def _periods(time: np.ndarray, on: BoolArray) -> tuple[tuple[float, float], ...]:
    """First and last instant of each period."""
    if len(time) == 1:
        return ()
    edges = np.diff(np.concatenate([[0], on.astype(int), [0]]))
    begins, ends = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0) - 1
    return tuple(zip(time[begins].tolist(), time[ends].tolist(), strict=True))

"""Where tensioners stand."""

from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.model import unstable_balance
from beltdyn.results.checks.finding import Evidence, Finding


def unstable_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners whose balance at rest is not stable."""
    names = str(evidence.recorded.attrs.get("unstable_tensioners", ""))
    for name in filter(None, names.split(", ")):
        yield Finding(unstable_balance(name))


def stopped_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners that lay on a stop at any time: from when to when, or since when at the end."""
    for number, tensioner in enumerate(evidence.drive.moving_tensioners):
        if tensioner.stops is None:
            continue
        position = np.asarray(evidence.recorded["tensioner_position"])[:, number]
        lower, upper = tensioner.stops
        for name, on in (("lower", position <= lower), ("upper", position >= upper)):
            if on.any():
                held = "It no longer keeps the tension:" if on[-1] else "It did not keep the tension then:"
                yield Finding(
                    f"the tensioner of {tensioner.pulley} {_when(on, evidence.time, name)}.",
                    held,
                    "change the length of the belt, or the stops.",
                )


def _when(on: BoolArray, time: FloatArray, stop: str) -> str:
    """Say since when it is on a stop, or from when to when it was and how often."""
    starts = np.flatnonzero(on & ~np.append(False, on[:-1]))
    if on[-1]:
        since = f" since t = {time[starts[-1]]:.4g} s" if len(time) > 1 else ""
        before = f", and was before from t = {time[starts[0]]:.4g} s on" if starts[1:].size else ""
        return f"is on its {stop} stop{since}{before}"
    last = float(time[np.flatnonzero(on)[-1]])
    often = f", {len(starts)} times" if len(starts) > 1 else ""
    return f"was on its {stop} stop between t = {time[starts[0]]:.4g} s and {last:.4g} s{often}"

"""Tensioners that are unstable or on a stop."""

from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.model import off_the_stop, unstable_balance
from beltdyn.parts.messages import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.incidents import on_stops

GROWTH = "growth"
"""Attribute of steady running: the fastest growing motion about it, growth rate and angular frequency, 1/s."""


def unstable_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners whose static equilibrium is unstable."""
    names = str(evidence.recorded.attrs.get("unstable_tensioners", ""))
    if names:
        yield unstable_balance(names.split(", "))


def unstable_control(evidence: Evidence) -> Iterator[Finding]:
    """Controllers that make steady running unstable."""
    if GROWTH in evidence.recorded.attrs:
        rate, swing = np.asarray(evidence.recorded.attrs[GROWTH], dtype=float)
        how = f"with {swing / (2.0 * np.pi):.3g} Hz" if swing > 0.0 else "without swinging"
        yield Finding(
            f"steady running is unstable: a small motion grows by {rate:.3g} 1/s {how}.",
            f"The controlled drive does not remain in it: after {np.log(10.0) / rate:.2g} s a disturbance is ten times "
            "as large.",
            "Reduce the gain of the controller, or increase its integral_time."
            if swing > 0.0
            else "Reverse the sign of the gain: rollers before the sensor need a negative one for their speed.",
        )


def stopped_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners on a stop at any time, and when."""
    for number, tensioner in enumerate(evidence.prepared.moving_tensioners):
        if tensioner.stops is None:
            continue
        lower, upper = (on[:, number] for on in on_stops(evidence.recorded, evidence.prepared))
        for name, on in (("lower", lower), ("upper", upper)):
            if on.any():
                tension = float(np.nanmean(np.asarray(evidence.recorded["span_tension"])[on]))
                yield Finding(
                    f"the tensioner of {tensioner.pulley} {_when(on, evidence.time, name)}.",
                    f"On the stop the belt length, not the spring, sets the tension ({tension:.4g} N on average).",
                    off_the_stop(name),
                )


def _when(on: BoolArray, time: FloatArray, stop: str) -> str:
    """Since when it is on a stop, or when and how often it was."""
    starts = np.flatnonzero(on & ~np.append(False, on[:-1]))
    if on[-1]:
        since = f" since t = {time[starts[-1]]:.4g} s" if len(time) > 1 else ""
        before = f", and first reached it at t = {time[starts[0]]:.4g} s" if starts[1:].size else ""
        return f"is on its {stop} stop{since}{before}"
    last = float(time[np.flatnonzero(on)[-1]])
    often = f", {len(starts)} times" if len(starts) > 1 else ""
    return f"was on its {stop} stop between t = {time[starts[0]]:.4g} s and {last:.4g} s{often}"

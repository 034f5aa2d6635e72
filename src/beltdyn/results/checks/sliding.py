"""Pulleys whose whole arc slides, or is near to it."""

from collections.abc import Iterator

import numpy as np

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.mechanics import capstan_margin, rim_speeds

MARGIN_LIMIT = 1.5
"""Smallest capstan margin that passes without a warning."""

SLIDING_LIMIT = 1e-3
"""Largest velocity of sliding of a whole arc, over the speed of the belt, that passes without a warning."""


def near_gross_slip(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that slide through at the end of the run, or are near to it; a belt held at an end slides for its use."""
    if evidence.drive.ends:
        return
    remedy = "Raise the tension or the wrap angle, or reduce the load."
    speeds = np.array([pulley.speed for pulley in evidence.pulleys])
    first = float(abs(rim_speeds(speeds, evidence.drive)[0]))
    for pulley in evidence.pulleys:
        sliding = abs(pulley.sliding_speed)
        if sliding > SLIDING_LIMIT * first:
            part = sliding / first if first > 0.0 else np.inf
            share = f", {part:.{0 if part > 0.1 else 1}%} of the rim's speed of {evidence.pulleys[0].name}"
            share = share if np.isfinite(part) else ""
            fault = f"{pulley.name} slides through: the whole arc slides, at {sliding:.3g} m/s{share}."
            yield Finding(fault, remedy=remedy)
        elif 0.0 < pulley.margin < MARGIN_LIMIT and first > 0.0:
            slips = f" slips {pulley.slip:.1%}," if np.isfinite(pulley.slip) and pulley.slip else ":"
            yield Finding(f"{pulley.name}{slips} gross slip at {pulley.margin:.1f} times this load.", remedy=remedy)


def near_gross_slip_before(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that reached gross slip earlier than at the end of the run, for more than a single output; as above."""
    if evidence.drive.ends:
        return
    tension, speed, wrap, torque = (
        np.asarray(evidence.recorded[name]) for name in ("span_tension", "belt_speed", "wrap_angle", "pulley_torque")
    )
    first, drive = evidence.window.first, evidence.drive
    times, margins = evidence.time[:first], capstan_margin(tension, speed, wrap, drive)[:first]
    reached = (margins < 1.0) & (drive.frictions > 0.0)
    for pulley, when, load in zip(drive.pulleys, reached.T, np.abs(torque[:first]).T, strict=True):
        if np.count_nonzero(when) > 1:
            yield Finding(
                f"{pulley.name} reached gross slip between t = {times[when][0]:.4g} s and {times[when][-1]:.4g} s, "
                f"first at {load[when][0]:.4g} N m: its load was more than friction transmits, for "
                f"{np.gradient(times)[when].sum():.2g} s in all.",
                remedy="Raise the tension or the wrap angle, or load it more gently.",
            )

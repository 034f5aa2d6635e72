"""How the run ended, and how a run-up began."""

from collections.abc import Iterator
from math import isnan, tau

import numpy as np

from beltdyn.model import Pulley
from beltdyn.parts.messages import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.schema import attribute, names

SETTLED = 0.01
"""Starting transient left in the span tensions at the start of a run-up, over the largest mean span tension."""
LEAST_WINDOWS = 5
"""Averaging windows needed to measure the remaining transient."""
_TURNS = 2.0
"""Least turns of the swept pulley, and waves of its slowest harmonic, in a window."""

NOTHING_RECORDED = Finding(
    "nothing was recorded: the run ended before its first output.",
    "The result holds no numbers.",
    "Run the drive again.",
)


def unfinished(evidence: Evidence) -> Iterator[Finding]:
    """A run that ended early."""
    status = evidence.recorded.attrs["status"]
    if status != "completed":
        ended = {"interrupted": "was interrupted", "failed": "failed"}.get(status, "is still going, or was killed")
        yield Finding(
            f"the run {ended}: results end at t = {evidence.time[-1]:.6g} s of "
            f"{evidence.prepared.simulation.end:.6g} s.",
            f"Means are taken from {evidence.window.start:.4g} s on and may include the starting transient.",
            "Run the drive again to complete it, unless it is still being computed.",
        )


def empty_rolls(evidence: Evidence) -> Iterator[Finding]:
    """Rolls from which more web runs than was on them."""
    if "roll_length" not in evidence.recorded:
        return
    for name, length in zip(
        names(evidence.recorded, "roll"), np.asarray(evidence.recorded["roll_length"]).T, strict=True
    ):
        if length[-1] < 0.0:
            at = float(evidence.time[np.argmax(length < 0.0)])
            yield Finding(
                f"the roll of the {name} is empty from t = {at:.4g} s on.",
                f"The web that runs on, {-length[-1]:.4g} m, is not there.",
                "Increase the radius or the length of the roll, or simulate a shorter time.",
            )


def least_window(pulley: Pulley, speed: float) -> float:
    """Shortest time over which means are taken while a pulley stays at the first speed (rad/s) of a run-up, s."""
    slowest = min((1.0, *(wave.order for wave in pulley.harmonics)))
    return _TURNS * tau / (slowest * abs(speed))


def unsettled(evidence: Evidence) -> Iterator[Finding]:
    """A run-up, or a run from steady running, that began before its starting transient had decayed."""
    left = attribute(evidence.recorded, "settling_left", 0.0)
    if not left < SETTLED and evidence.prepared.simulation.start == "steady":
        yield Finding(
            f"steady running had not settled on the travelling mesh: a transient of {left:.1%} of the largest mean "
            "span tension remains.",
            "The first part of the run still shows this transient.",
            'Set simulation.frame = "staying", or increase belt.elements.',
        )
    elif not left < SETTLED:
        much, longer = f"a transient of {left:.1%} of the largest mean span tension", "a longer settling time"
        swept = [one for one in evidence.prepared.pulleys if one.name == evidence.recorded.attrs.get("swept_pulley")]
        if isnan(left) and swept and swept[0].speed is not None:
            window = least_window(swept[0], float(swept[0].speed.at(evidence.time[:1])[0]))
            much, longer = (
                "a transient of unknown size",
                f"a settling time of {LEAST_WINDOWS * window:.2g} s or more",
            )
        yield Finding(
            f"the drive had not settled at the first speed when the run-up began: {much} remains.",
            "It distorts the spectra at the lowest speeds.",
            f"Set {longer}, or start at a higher speed.",
        )

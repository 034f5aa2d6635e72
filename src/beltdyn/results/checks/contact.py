"""Contact and tension that are lost."""

from collections.abc import Iterator

import numpy as np

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.recorded import names


def slack_spans(evidence: Evidence) -> Iterator[Finding]:
    """Spans whose tension falls to zero at any time."""
    tensions = np.asarray(evidence.recorded["span_tension"])
    for name, tension in zip(names(evidence.recorded, "span"), tensions.T, strict=True):
        lowest = float(tension.min())
        if lowest <= 0.0:
            time = float(evidence.time[int(tension.argmin())])
            yield Finding(
                f"the span {name} is slack: its tension falls to {lowest:.4g} N at t = {time:.4g} s.",
                remedy="Shorten the belt, or reduce the load.",
            )


def leaves_pulley(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that the belt leaves, of those it is laid on."""
    free = np.asarray(evidence.recorded["wrap_angle"]) <= 0.0
    drive = evidence.drive
    for pulley, laid, left in zip(drive.pulleys, drive.path.wrap_angles, free.T, strict=True):
        if laid > 0.0 and left.any():
            time = float(evidence.time[int(left.argmax())])
            yield Finding(f"the belt leaves the pulley {pulley.name} at t = {time:.4g} s.", remedy="Raise the tension.")

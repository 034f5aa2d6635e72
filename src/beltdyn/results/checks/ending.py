"""How the run ended, and how a run-up began."""

from collections.abc import Iterator
from math import isnan, tau

from beltdyn.model import Pulley
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.recorded import attribute

SETTLED = 0.01
"""What may be left of the start of a run-up in the span tensions, over the largest mean one."""
LEAST_WINDOWS = 5
"""Windows of means from which on it is known what is left."""
_TURNS = 2.0
"""Turns of the swept pulley, and waves of its slowest harmonic, that a window holds at least."""

NOTHING_RECORDED = Finding(
    "nothing was recorded: the run ended before its first output.",
    "There are no numbers.",
    "Run the drive again.",
)


def unfinished(evidence: Evidence) -> Iterator[Finding]:
    """Say that the run ended before its time."""
    status = evidence.recorded.attrs["status"]
    if status != "completed":
        ended = {"interrupted": "was interrupted", "failed": "failed"}.get(status, "goes on, or was killed")
        yield Finding(
            f"the run {ended}: results end at t = {evidence.time[-1]:.6g} s of {evidence.drive.simulation.end:.6g} s.",
            f"Means are those from {evidence.window.start:.4g} s on, and may be those of a start.",
            "Run the drive again for the rest, unless it is being computed.",
        )


def least_window(pulley: Pulley, speed: float) -> float:
    """Shortest time over which means are taken while a pulley stays at the first speed (rad/s) of a run-up, s."""
    slowest = min((1.0, *(wave.order for wave in pulley.harmonics)))
    return _TURNS * tau / (slowest * abs(speed))


def unsettled(evidence: Evidence) -> Iterator[Finding]:
    """Say that a run-up, or a run from steady running, began before the transients of its start had died."""
    left = attribute(evidence.recorded, "settling_left", 0.0)
    if not left < SETTLED and evidence.drive.simulation.start == "steady":
        yield Finding(
            f"steady running had not settled on the mesh that travels: {left:.1%} of the largest mean span tension is "
            "still on its way.",
            "What the run shows at its beginning is in part that.",
            'Set simulation.frame = "staying", or give more belt.elements.',
        )
    elif not left < SETTLED:
        much, longer = f"{left:.1%} of the largest mean span tension was", "a longer settling"
        swept = [one for one in evidence.drive.pulleys if one.name == evidence.recorded.attrs.get("swept_pulley")]
        if isnan(left) and swept and swept[0].speed is not None:
            window = least_window(swept[0], float(swept[0].speed.at(evidence.time[:1])[0]))
            much, longer = (
                "an unknown part of the tensions was",
                f"a settling of {LEAST_WINDOWS * window:.2g} s or more",
            )
        yield Finding(
            f"the first speed had not settled when the run-up began: {much} still due to the start.",
            "It spoils spectra at the lowest speeds.",
            f"Give {longer}, or begin at a higher speed.",
        )

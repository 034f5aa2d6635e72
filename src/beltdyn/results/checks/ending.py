"""How the run ended, and how a run-up began."""

from collections.abc import Iterator

from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.recorded import attribute

SETTLED = 0.01
"""What may be left of the start of a run-up in the span tensions, over the largest mean one."""

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
            f"the run {ended}: results end at t = {evidence.time[-1]:.6g} s "
            f"of {evidence.drive.simulation.duration:.6g} s.",
            f"Means are those from {evidence.window.start:.4g} s on, and may be those of a start.",
            "Run the drive again for the rest, unless it is being computed.",
        )


def unsettled(evidence: Evidence) -> Iterator[Finding]:
    """Say that a run-up began before the transients of its start had died."""
    left = attribute(evidence.recorded, "settling_left", 0.0)
    if not left < SETTLED:
        much = f"{left:.1%} of the largest mean span tension is" if left > 0.0 else "an unknown part of the tensions is"
        yield Finding(
            f"the run-up begins before the start is over: {much} still on its way to the steady state.",
            "It spoils spectra at the lowest speeds.",
            "Give a longer settling, or begin at a higher speed.",
        )

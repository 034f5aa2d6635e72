"""How the run ended."""

from collections.abc import Iterator

from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence

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

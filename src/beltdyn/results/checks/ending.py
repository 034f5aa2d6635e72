"""How the run ended."""

from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding


def unfinished(evidence: Evidence) -> Iterator[Finding]:
    """Say that the run ended before its time."""
    status = evidence.recorded.attrs["status"]
    if status != "completed":
        ended = {"interrupted": "was interrupted", "failed": "failed"}.get(status, "goes on, or was killed")
        yield Finding(
            f"the run {ended}: results end at t = {evidence.time[-1]:.6g} s "
            f"of {evidence.drive.simulation.duration:.6g} s."
        )

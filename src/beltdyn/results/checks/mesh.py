"""What the mesh does not resolve, and which one would."""

import tomllib
from collections.abc import Iterator

from beltdyn.model import ERROR_LIMITS, unresolved
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.resolution import found_errors


def unresolved_by_mesh(evidence: Evidence) -> Iterator[Finding]:
    """Quantities whose errors, estimated or found by a finer mesh, are above their limits."""
    found = found_errors(evidence.recorded)
    worse = [f"{name} ({error:.1%})" for name, error in found.items() if error > ERROR_LIMITS[name]]
    if worse:
        yield Finding(
            f"the mesh does not resolve {', '.join(worse)}.",
            "The numbers change by as much on a finer mesh.",
            "Leave `elements` out for a graded mesh, or lower `force_tolerance`.",
        )
    if not found:
        errors, needed = evidence.resolution.errors, evidence.resolution.needed
        yield from unresolved(errors, needed, pressures=_given(evidence))


def _given(evidence: Evidence) -> bool:
    """Whether the drive file gives the number of elements; the drive of a run may hold one that was chosen."""
    text = evidence.recorded.attrs.get("drive_as_given")
    return evidence.drive.belt.elements is not None if text is None else "elements" in tomllib.loads(str(text))["belt"]

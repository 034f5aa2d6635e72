"""What the mesh does not resolve, and which one would."""

from collections.abc import Iterator

from beltdyn.model import unresolved
from beltdyn.results.checks.finding import Evidence, Finding


def unresolved_by_mesh(evidence: Evidence) -> Iterator[Finding]:
    """Quantities whose estimated errors are above their limits."""
    said = unresolved(evidence.resolution.errors, evidence.resolution.needed)
    if said:
        fault, remedy = said
        yield Finding(fault, "Speeds need fewer elements.", remedy)

"""What the mesh does not resolve, and which one would."""

from collections.abc import Iterator

from beltdyn.model import unresolved
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence


def unresolved_by_mesh(evidence: Evidence) -> Iterator[Finding]:
    """Quantities whose estimated errors are above their limits."""
    yield from unresolved(evidence.resolution.errors, evidence.resolution.needed)
